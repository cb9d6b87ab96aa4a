# timeout: 200
"""Requirement: the documentation builds without a warning, every link inside the site leads to a page, a heading or a file that is there, nothing
of a page is loaded from another machine, and a formula or a link that is wrong ends the build."""
import html.parser
import pathlib
import shutil
import subprocess
import sys
import urllib.parse

import harness

# Links out of the site that a reader follows by hand: none is loaded with a page.
CITED = {"https://semver.org"}


class Page(html.parser.HTMLParser):
    """What a page links to, what it loads, and the places that a link can lead to."""

    def __init__(self, file):
        super().__init__()
        self.links, self.loads, self.places = [], [], set()
        self.feed(file.read_text())

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.places |= {attributes[key] for key in ("id", "name") if attributes.get(key)}
        if tag == "a" and "href" in attributes:
            self.links.append(attributes["href"])
        elif tag == "link":
            self.loads.append(attributes.get("href", ""))
        elif tag in ("img", "script", "source", "iframe", "object", "video"):
            self.loads += [attributes[key] for key in ("src", "data") if key in attributes]


def build(source, out):
    return subprocess.run([sys.executable, "-B", source / "docs" / "site" / "build.py", out], capture_output=True, text=True)


class Documentation(harness.CaseTest):
    def test_site(self):
        out = self.work / "site"
        run = build(harness.SOURCE_DIR, out)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        pages = {file: Page(file) for file in out.rglob("*.html")}
        wrong = []
        for file, page in pages.items():
            for target in page.links + page.loads:
                name, (address, place) = file.relative_to(out), urllib.parse.urldefrag(target)
                if urllib.parse.urlparse(target).scheme or target.startswith("//"):
                    if target in page.loads or target not in CITED:
                        wrong.append(f"{name}: {target} leaves the site")
                    continue
                path = urllib.parse.unquote(urllib.parse.urlparse(address).path)
                there = (file.parent / path).resolve() if path else file
                if not there.is_file():
                    wrong.append(f"{name}: {target} is not there")
                elif place and there in pages and urllib.parse.unquote(place) not in pages[there].places:
                    wrong.append(f"{name}: {target} has no such heading")
        self.assertFalse(wrong, "\n".join(wrong))
        text = "".join(file.read_text() for file in pages)
        self.assertGreater(text.count('class="katex"'), 50, "formulas are set")
        self.assertEqual({pathlib.Path(case).parent.name for case in harness.SOURCE_DIR.glob("cases/*/README.md")},
                         {file.parent.name for file in pages if file.name == "README.html"})
        gallery = (out / "docs" / "gallery.html").read_text()
        for case in harness.SOURCE_DIR.glob("cases/*/README.md"):
            self.assertIn(f"cases/{case.parent.name}<", gallery.replace("</span>", "").replace('<span class="pre">', ""), "a card for each case")
        style = (out / "_static" / "katex" / "katex.min.css").read_text()
        self.assertIn("KaTeX_Main-Regular.woff2", style)
        self.assertTrue((out / "_static" / "katex" / "fonts" / "KaTeX_Main-Regular.woff2").is_file())
        print(f"  {len(pages)} pages, {sum(len(page.links) + len(page.loads) for page in pages.values())} links")

    def test_mistakes_end_the_build(self):
        tree = self.work / "tree"
        (tree / "docs").mkdir(parents=True)
        for name in ("CITATION.cff", "CMakeLists.txt"):
            shutil.copy(harness.SOURCE_DIR / name, tree)
        shutil.copytree(harness.SOURCE_DIR / "docs" / "site", tree / "docs" / "site")
        for text, message in (("$\\fracc{1}{2}$", "fracc"), ("[there](nowhere.md)", "nowhere.md")):
            (tree / "docs" / "index.md").write_text(f"# Title\n\n{text}\n")
            run = build(tree, self.work / "site")
            self.assertNotEqual(run.returncode, 0, text)
            self.assertIn(message, run.stderr)
        (tree / "docs" / "index.md").write_text("# Title\n\n$\\frac{1}{2}$\n")
        self.assertEqual(build(tree, self.work / "site").returncode, 0)


if __name__ == "__main__":
    harness.main()
