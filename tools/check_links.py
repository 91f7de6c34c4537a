#!/usr/bin/env python3
"""Checks the links between Markdown pages: every target and every anchor has to exist.

  tools/check_links.py FOLDER

FOLDER is the root of the repository. Prints one line per dead link; exit status 1 if there is any.
Links to other hosts are not followed.
"""
import os
import re
import sys

LINK = re.compile(r'\]\(([^)\s]+)\)|(?:src|href)="([^"]+)"')
SKIPPED = {".git", "build", "node_modules"}


def pages(root):
    for folder, folders, names in os.walk(root):
        folders[:] = [f for f in folders if f not in SKIPPED]
        for name in names:
            if name.endswith(".md"):
                yield os.path.join(folder, name)


def anchors(text):
    """Anchors of headings, as code hosts make them."""
    titles = re.findall(r"^#+\s+(.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", re.sub(r"[`*]", "", t).strip().lower()).replace(" ", "-")
            for t in titles}


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


def main():
    dead = [(page, link) for page in pages(sys.argv[1]) for link in dead_links(page)]
    for page, link in dead:
        print(f"{os.path.relpath(page, sys.argv[1])}: dead link {link}")
    return 1 if dead else 0


if __name__ == "__main__":
    sys.exit(main())
