# labels: long
# timeout: 900
"""Requirement: diagnose_published.py for fibres in a shear flow and spheres in a tank, whose diagnosis takes a minute."""
import diagnose_published
import harness


class LongPublished(diagnose_published.Published):
    is_long = True


del diagnose_published.Published

if __name__ == "__main__":
    harness.main()
