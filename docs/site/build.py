#!/usr/bin/env python3
"""Builds the documentation: python3 docs/site/build.py OUT [--headers]. The first page is OUT/index.html.

--headers adds the pages of the public headers, made by Doxygen. Warnings are errors in all of it.
"""
import argparse
import pathlib
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
KATEX = pathlib.Path("/usr/share/javascript/katex")


def build_pages(out, with_headers):
    shutil.rmtree(out, ignore_errors=True)
    tags = ["-t", "headers"] if with_headers else []
    run = subprocess.run([sys.executable, "-B", "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", "-c", HERE, "-d", out / ".doctrees", *tags, ROOT, out])
    if run.returncode:
        sys.exit(run.returncode)
    style = out / "_static" / "katex"
    (style / "fonts").mkdir(parents=True)
    shutil.copy(KATEX / "katex.min.css", style)
    for font in (KATEX / "fonts").glob("*.woff2"):
        shutil.copy(font, style / "fonts")
    shutil.rmtree(out / ".doctrees")
    (out / "index.html").write_text('<!doctype html><meta charset="utf-8"><title>Snag</title><meta http-equiv="refresh" content="0; url=docs/index.html">\n'
                                    '<a href="docs/index.html">Documentation of Snag</a>\n')


def build_headers(out):
    settings = (HERE / "Doxyfile").read_text() + f"\nOUTPUT_DIRECTORY = {out}\n"
    run = subprocess.run(["doxygen", "-"], input=settings, text=True, cwd=ROOT, stdout=subprocess.DEVNULL)
    if run.returncode:
        sys.exit(run.returncode)


if __name__ == "__main__":
    arguments = argparse.ArgumentParser(description=__doc__)
    arguments.add_argument("out", type=pathlib.Path)
    arguments.add_argument("--headers", action="store_true")
    options = arguments.parse_args()
    build_pages(options.out.resolve(), options.headers)
    if options.headers:
        build_headers(options.out.resolve())
    print(f"documentation: {options.out / 'index.html'}")
