#!/usr/bin/env python3
"""Every link of the project's pages leads to a file or a heading that is there, and the short list leads from the
README to the code in at most two links.

usage: links_test.py ROOT        (prints a sentence for each link that leads nowhere; exit code 1 if there is one)
"""
import pathlib
import re
import sys

PAGES = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "docs/*.md", "docs/notes/*.md", "scenes/*.md"]
LINK = re.compile(r"\[[^\]]*\]\(([^()\s]+)\)")

# What a reader looks for, and the file that has it.
SHORT_LIST = {
    "packets": "src/soft/clip/packet_solver-inl.h",
    "quads": "src/soft/occluders/quads.h",
    "silhouette boundary": "src/soft/silhouette/silhouette_boundary-inl.h",
    "shaft margin": "src/soft/shafts/shaft_cull-inl.h",
    "field look-up": "src/ao/field/field_lookup.h",
    "cone test": "src/shadow/cone_tree/node_tests-inl.h",
    "exact decision": "src/shadow/decision/decide.cpp",
}


def lines_of_text(path):
    """Numbered lines of a page without its blocks of code."""
    in_code = False
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.startswith("```"):
            in_code = not in_code
        elif not in_code:
            yield number, line


def anchor(heading):
    """The anchor that a heading of Markdown gets: letters, digits, - and _ in lower case, blanks as -."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading.lstrip("#").strip())
    return re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")


def anchors(path):
    return {anchor(line) for _, line in lines_of_text(path) if line.startswith("#")}


def links(path):
    """(line number, target) of each link that stays within the project."""
    for number, line in lines_of_text(path):
        for target in LINK.findall(re.sub(r"`[^`]*`(?!\])", "", line)):
            if "://" not in target:
                yield number, target


def broken_links(root, path):
    for number, target in links(path):
        name, _, fragment = target.partition("#")
        file = (path.parent / name).resolve() if name else path
        where = f"{path.relative_to(root)}:{number}"
        if not file.exists():
            yield f"{where}: found a link to {target}, expected a file that is there"
        elif fragment and file.suffix == ".md" and fragment not in anchors(file):
            yield f"{where}: found a link to {target}, expected one of that page's headings"


def linked_files(path):
    return {(path.parent / target.partition("#")[0]).resolve() for _, target in links(path)}


def beyond_two_links(root):
    first = linked_files(root / "README.md")
    reached = set(first)
    for page in first:
        if page.suffix == ".md" and page.is_file():
            reached |= linked_files(page)
    for what, file in SHORT_LIST.items():
        if (root / file).resolve() not in reached:
            yield f"README.md: {file} ({what}) is not reached in two links"


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    pages = [page for pattern in PAGES for page in sorted(root.glob(pattern))]
    found = [sentence for page in pages for sentence in broken_links(root, page)]
    found += beyond_two_links(root)
    print("\n".join(found) or "every link leads somewhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
