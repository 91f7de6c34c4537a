#!/usr/bin/env python3
"""Checks the links between Markdown pages, and what comments of the code cite of them: every page,
every anchor and every heading has to exist.

  tools/check_links.py FOLDER

FOLDER is the root of the repository. Prints one line per dead link; exit status 1 if there is any.
Links to other hosts are not followed.
"""
import os
import re
import sys

LINK = re.compile(r'\]\(([^)\s]+)\)|(?:src|href)="([^"]+)"')
CITATION = re.compile(r'\b(docs/[\w./-]+\.md)(?:[,:]? "([^"]+)")?')
SKIPPED = {".git", "build", "node_modules"}


def pages(root):
    for folder, folders, names in os.walk(root):
        folders[:] = [f for f in folders if f not in SKIPPED]
        for name in names:
            if name.endswith(".md"):
                yield os.path.join(folder, name)


def titles(text):
    """Headings of a page, and the bold beginnings of its paragraphs, in lower case."""
    found = re.findall(r"^#+\s+(.*)$", text, re.MULTILINE)
    found += re.findall(r"^(?:- |\d+\. )?\*\*([^*]+?)[.:]?\*\*", text, re.MULTILINE)
    return {re.sub(r"[`*]", "", t).strip().lower() for t in found}


def anchors(text):
    """Anchors of headings, as code hosts make them."""
    return {re.sub(r"[^\w\- ]", "", t).replace(" ", "-") for t in titles(text)}


def read(page):
    with open(page, encoding="utf-8") as file:
        return file.read()


def dead_links(page):
    text = re.sub(r"```.*?```", "", read(page), flags=re.DOTALL)
    for match in LINK.finditer(text):
        link = match.group(1) or match.group(2)
        if re.match(r"[a-z]+:", link):
            continue
        path, _, anchor = link.partition("#")
        target = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if not os.path.exists(target):
            yield link
        elif anchor and target.endswith(".md") and anchor not in anchors(read(target)):
            yield link


def dead_citations(root):
    """Citations in code, as docs/PAGE.md, "HEADING"; a comment may break the line between them."""
    for folder in ("src", "include", "tests"):
        for where, _, names in os.walk(os.path.join(root, folder)):
            for name in names:
                if not name.endswith((".h", ".cpp")):
                    continue
                file = os.path.join(where, name)
                text = re.sub(r"\n\s*///? ?", " ", read(file))
                for match in CITATION.finditer(text):
                    page = os.path.join(root, match.group(1))
                    heading = match.group(2)
                    if not os.path.exists(page):
                        yield file, match.group(1)
                    elif heading and heading.lower() not in titles(read(page)):
                        yield file, match.group(0)


def main():
    root = sys.argv[1]
    dead = [(page, link) for page in pages(root) for link in dead_links(page)]
    dead += dead_citations(root)
    for page, link in dead:
        print(f"{os.path.relpath(page, root)}: dead link {link}")
    return 1 if dead else 0


if __name__ == "__main__":
    sys.exit(main())
