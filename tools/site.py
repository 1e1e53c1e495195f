#!/usr/bin/env python3
"""Makes the documentation site with MkDocs: the README as its start, the pages of docs, and the files of the project that
they link to, as they are. Warnings are errors.

usage: site.py FOLDER        (the site is FOLDER/site; packages mkdocs and, to check it, linkchecker)
"""
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGES = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "scenes/README.md"]
LINK = re.compile(r"(\[[^\]]*\])\(([^()\s]+)\)")


def place_of(path):
    """Where a file of the project is in the site's pages; text that is no page gets an ending that browsers show."""
    if path == pathlib.Path("README.md"):
        return pathlib.Path("index.md")
    shown = path.suffix in (".md", ".png", ".svg")
    return path if shown else pathlib.Path("files", str(path) + ".txt")


def tracked():
    """The project's files; links to anything else, and to folders, lose their address."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "-z"], check=True, capture_output=True, text=True).stdout
    return {pathlib.Path(name) for name in listed.split("\0") if name}


def translated(page, text, files, wanted):
    """The page with links from its place in the site. Files that it links to are added to `wanted`."""
    here = place_of(page).parent

    def link(match):
        words, address = match.groups()
        name, _, heading = address.partition("#")
        if "://" in address or address.startswith("mailto:") or not name:
            return match.group(0)
        target = pathlib.Path(*(ROOT / page.parent / name).resolve().relative_to(ROOT).parts)
        if target not in files:
            return words[1:-1]
        wanted.add(target)
        up = pathlib.Path(*[".."] * len(here.parts))
        return "%s(%s%s)" % (words, (up / place_of(target)).as_posix(), "#" + heading if heading else "")

    parts = re.split(r"(^```.*?^```$)", text, flags=re.S | re.M)  # code stays as it is
    return "".join(part if part.startswith("```") else LINK.sub(link, part) for part in parts)


def main(folder):
    pages, files = folder / "pages", tracked()
    wanted = {file for file in files if file.match("docs/*.png") or file.match("docs/*.svg")}
    shutil.rmtree(folder, ignore_errors=True)
    for page in [pathlib.Path(name) for name in PAGES] + sorted(
            f for f in files if f.match("docs/*.md") or f.match("docs/notes/*.md")):
        to = pages / place_of(page)
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(translated(page, (ROOT / page).read_text(encoding="utf-8"), files, wanted), encoding="utf-8")
    for file in sorted(wanted):
        to = pages / place_of(file)
        if not to.exists():
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / file, to)
    settings = (ROOT / "docs" / "mkdocs.yml").read_text(encoding="utf-8")
    (folder / "mkdocs.yml").write_text(settings + "docs_dir: pages\nsite_dir: site\n", encoding="utf-8")
    return subprocess.run(["mkdocs", "build", "--strict", "--quiet", "-f", folder / "mkdocs.yml"], check=False).returncode


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
