"""Requirement: texts for the user (pages, messages, reports) use the words of the field and none of the story words below."""
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(sys.argv[1])
# Story word -> plain words.
WORDS = {
    "told": "reported, shown, distinguished",
    "tell": "show, distinguish",
    "tells": "shows, distinguishes",
    "mop": "remove",
    "mops": "removes",
    "journey": "path, passage",
    "ought": "must, should",
    "nobody": "no force, no user",
}
STORY = re.compile(r"\b(" + "|".join(WORDS) + r")\b", re.IGNORECASE)
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')


def user_texts(path):
    """(line number, text) of a page, or of the string literals with a blank in a source file."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        if path.suffix == ".md":
            yield number, line
        elif not line.lstrip().startswith(("//", "#include")):
            yield from ((number, text) for text in LITERAL.findall(line) if " " in text)


files = subprocess.run(["git", "-C", root, "ls-files", "*.md", "*.cpp", "*.hpp"], capture_output=True, text=True, check=True).stdout.split()
checked = [root / name for name in files if not name.startswith("tests/") and (root / name).exists()]
if len(checked) < 100:
    sys.exit(f"only {len(checked)} files with texts: is {root} the tree?")
found = [f"{path.relative_to(root)}:{number}: \"{match.group()}\", write {WORDS[match.group().lower()]}: {text.strip()[:120]}"
         for path in checked for number, text in user_texts(path) for match in STORY.finditer(text)]
print("\n".join(found) or f"{len(checked)} files without story words")
sys.exit(bool(found))
