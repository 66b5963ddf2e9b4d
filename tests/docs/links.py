#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Every relative link of a Markdown page leads to a file that is installed with it, every anchor to a heading, every
page of driver/docs that a source names exists, and the index of the guides lists each page.

Usage: links.py FOLDER   a source folder, or an installation's share/doc/hapticd
Exit code 1: a link leads nowhere; all of them are printed as file:line."""
import pathlib
import re
import subprocess
import sys

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)\)")
MENTION = re.compile(r"driver/docs/[\w./-]*\w\.(?:md|svg|png|[1-8])\b")


def slug(heading):
    """The anchor that Git forges make of a heading."""
    plain = re.sub(r"[`*]|\[|\]\([^)]*\)", "", heading).strip().lower()
    return re.sub(r"\s", "-", re.sub(r"[^\w\s-]", "", plain))


def anchors(page):
    return {slug(line.lstrip("#")) for line in page.read_text().splitlines() if line.startswith("#")}


def leaves_docs(page, to, root):
    """Only driver/docs is installed with its pages."""
    docs = root / "driver/docs"
    return page.is_relative_to(docs) and not to.resolve().is_relative_to(docs)


def broken_links(page, root):
    fenced = False
    for number, line in enumerate(page.read_text().splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        if fenced:
            continue
        for target in LINK.findall(line):
            if re.match(r"[a-z]+:", target):
                continue
            file, _, anchor = target.partition("#")
            to = (page.parent / file) if file else page
            if not to.exists():
                yield f"{page.relative_to(root)}:{number}: {target}: no such file"
            elif leaves_docs(page, to, root):
                yield f"{page.relative_to(root)}:{number}: {target}: is not installed with the pages of driver/docs"
            elif anchor and anchor not in anchors(to):
                yield f"{page.relative_to(root)}:{number}: {target}: no such heading"


def broken_mentions(file, root):
    try:
        text = file.read_text()
    except (UnicodeDecodeError, FileNotFoundError):
        return
    for number, line in enumerate(text.splitlines(), 1):
        for mention in MENTION.findall(line):
            if not (root / mention).exists():
                yield f"{file.relative_to(root)}:{number}: {mention}: no such file"


def unlisted(docs):
    """Pages that the index of the guides does not list."""
    index = docs / "README.md"
    listed = {(docs / target.partition("#")[0]).resolve() for target in LINK.findall(index.read_text())}
    for page in [*docs.glob("*.md"), *docs.glob("reports/*.md")]:
        if page != index and page.resolve() not in listed:
            yield f"{index}: does not list {page.relative_to(docs)}"


def report(files, broken):
    pages = sum(f.suffix == ".md" for f in files)
    if pages < 20:
        broken.append(f"only {pages} pages found, expected the documentation")
    print("\n".join(broken) or f"{pages} pages: every link leads somewhere")
    return 1 if broken else 0


def main(root):
    if not (root / "driver").exists():
        files = [p for p in root.rglob("*") if p.is_file()]
        return report(files, [b for f in files if f.suffix == ".md" for b in broken_links(f, root)])
    listed = subprocess.run(["git", "-C", root, "ls-files"], text=True, capture_output=True)
    if listed.returncode:  # a source package has no repository
        files = [p for top in ("driver", "plugins", "devices", "config", "udev", "tests") for p in (root / top).rglob("*") if p.is_file()]
        files += [root / "README.md", root / "CHANGELOG.md"]
    else:
        files = [root / name for name in listed.stdout.splitlines() if (root / name).is_file()]
    pages = [f for f in files if f.suffix == ".md" and "/page/" not in str(f)]
    broken = [b for page in pages for b in broken_links(page, root)]
    broken += [b for file in files if file.name != "CHANGELOG.md" for b in broken_mentions(file, root)]
    broken += unlisted(root / "driver/docs")
    return report(files, broken)


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
