# labels: long
# timeout: 1800
# processors: 2
"""Requirement: diagnose_other_program.py, with all truths."""
import diagnose_other_program
import harness


class AllTruths(diagnose_other_program.OtherProgram):
    sets = tuple(name for name, *_ in diagnose_other_program.SETS)


del diagnose_other_program.OtherProgram

if __name__ == "__main__":
    harness.main()
