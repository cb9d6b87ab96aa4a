"""Sphinx extension of this site: formulas set by KaTeX while the site is built, the gallery of cases, the keys of summary.json.

A page needs no script and no network for its formulas. A formula that KaTeX cannot set is a warning, and warnings are errors.
"""
import json
import pathlib
import re
import subprocess

from docutils import nodes
from docutils.parsers.rst import Directive, directives
from sphinx import addnodes
from sphinx.util import logging

log = logging.getLogger(__name__)
HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[1]


class Katex:
    """One process of node for all formulas, started with the first one."""

    process = None

    @classmethod
    def html(cls, tex, block, place):
        if cls.process is None:
            cls.process = subprocess.Popen(["node", HERE / "katex.js"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        cls.process.stdin.write(json.dumps({"tex": tex, "block": block}) + "\n")
        cls.process.stdin.flush()
        answer = json.loads(cls.process.stdout.readline())
        if "error" in answer:
            log.warning("formula %r: %s", tex, answer["error"], location=place)
        return answer.get("html", "")

    @classmethod
    def end(cls, *_):
        if cls.process:
            cls.process.communicate()
            cls.process = None


def visit_inline(translator, node):
    translator.body.append(Katex.html(node.astext(), False, node))
    raise nodes.SkipNode


def visit_block(translator, node):
    translator.body.append(translator.starttag(node, "div", CLASS="math-block"))
    translator.body.append(Katex.html(node.astext(), True, node) + "</div>\n")
    raise nodes.SkipNode


def plain(text):
    """Markdown of one paragraph as plain text."""
    return re.sub(r"\s+", " ", re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", text).replace("`", "").replace("**", "")).strip()


def card_of(case):
    """Title, first paragraph in words, and first picture of a case's README."""
    text = (case / "README.md").read_text()
    title = plain(re.match(r"# (.*)", text)[1])
    blocks = [block for block in re.split(r"\n\n+", text)[1:] if not re.match(r"    |#|!|\||```", block)]
    picture = re.search(r"!\[[^\]]*\]\(([^)]+)\)", text)
    return title, plain(blocks[0]), picture and picture[1]


class Gallery(Directive):
    """A card for each named case: picture, title, first words. The content is the list of cases, "NAME" or "NAME PICTURE"."""

    has_content = True

    def run(self):
        env = self.state.document.settings.env
        gallery = nodes.container(classes=["gallery"])
        for line in self.content:
            name, _, picture = line.partition(" ")
            case = ROOT / "cases" / name
            title, words, found = card_of(case)
            env.note_dependency(str(case / "README.md"))
            card = nodes.container(classes=["card"])
            source = picture or (found and f"/cases/{name}/{found}")
            if source:
                card += nodes.image(uri=source, alt=title, candidates={})
            link = addnodes.pending_xref("", refdomain="std", reftype="doc", reftarget=f"/cases/{name}/README", refexplicit=True, refwarn=True)
            link["refdoc"] = env.docname
            link += nodes.strong(text=title)
            card += nodes.paragraph("", "", link)
            card += nodes.paragraph(text=words if len(words) < 200 else words[: words.rfind(" ", 0, 200)] + " ...")
            card += nodes.paragraph("", "", nodes.literal(text=f"cases/{name}"))
            gallery += card
        return [gallery]


def rows_of(schema, prefix=""):
    """(key, type, description) of all keys of a schema, tables before what they hold."""
    for key, one in schema["properties"].items():
        kinds = one.get("type", "string")
        yield prefix + key, " or ".join([kinds] if isinstance(kinds, str) else kinds), one["description"] + words_of(one)
        if "properties" in one:
            yield from rows_of(one, prefix + key + ".")
        if "properties" in one.get("items", {}):
            yield from rows_of(one["items"], prefix + key + "[].")


def words_of(one):
    return ": " + ", ".join(one["enum"]) if "enum" in one else ""


class SummaryKeys(Directive):
    """The keys of a JSON schema as a table; the argument is its file from the root of the tree."""

    required_arguments = 1

    def run(self):
        file = ROOT / self.arguments[0]
        self.state.document.settings.env.note_dependency(str(file))
        table = nodes.table(classes=["schema"])
        group = nodes.tgroup(cols=3)
        table += group
        for width in (35, 15, 50):
            group += nodes.colspec(colwidth=width)
        head, body = nodes.thead(), nodes.tbody()
        group += [head, body]

        def row(cells):
            line = nodes.row()
            for cell in cells:
                line += nodes.entry("", nodes.paragraph("", "", *cell))
            return line

        head += row([[nodes.Text(word)] for word in ("key", "type", "unit and meaning")])
        for key, kind, meaning in rows_of(json.loads(file.read_text())):
            parts = re.split(r"`([^`]*)`", meaning)
            words = [nodes.literal(text=part) if i % 2 else nodes.Text(part) for i, part in enumerate(parts)]
            body += row([[nodes.literal(text=key)], [nodes.Text(kind)], words])
        return [table]


def setup(app):
    app.add_html_math_renderer("katex", (visit_inline, None), (visit_block, None))
    app.add_directive("gallery", Gallery)
    app.add_directive("summary-keys", SummaryKeys)
    app.connect("build-finished", Katex.end)
    return {"parallel_read_safe": True, "parallel_write_safe": False}
