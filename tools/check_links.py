"""Checks the links between the pages of the project: files that they name, and headings.

Usage: check_links.py [ROOT]. Prints one line a fault; exit code 1 when there is one. Links to other sites are not fetched.
"""

import os
import pathlib
import re
import sys
import urllib.parse

SKIPPED_FOLDERS = re.compile(r"\.|build|dist$|out$|mjarm-out$|node_modules$")
FENCE = re.compile(r"\s*(`{3,}|~{3,})")
LINK = re.compile(r"\[(?:[^\[\]]|\[[^\[\]]*\])*\]\(\s*<?([^()\s<>]*(?:\([^()\s]*\)[^()\s]*)*)>?(?:\s+\"[^\"]*\")?\s*\)")
TAG = re.compile(r"""<(?:a|img|source|video)\b[^>]*?\b(?:href|src)=["']([^"']+)["']""")
ANCHOR = re.compile(r"""<\w+\b[^>]*?\b(?:id|name)=["']([^"']+)["']""")


def pages_of(root):
    """Every markdown file of the project, without what is built or fetched."""
    for folder, folders, files in os.walk(root):
        folders[:] = sorted(name for name in folders if not SKIPPED_FOLDERS.match(name))
        yield from (pathlib.Path(folder) / name for name in sorted(files) if name.endswith(".md"))


def prose(text):
    """(number, line) of what is no code; spans of code are blanked."""
    end = None
    for number, line in enumerate(text.splitlines(), 1):
        fence = FENCE.match(line)
        if fence and end is None:
            end = fence.group(1)
        elif fence and line.strip().startswith(end) and not line.strip().strip(end[0]):
            end = None
        elif end is None:
            yield number, line


def without_code(line):
    return re.sub(r"(`+)(?!`).*?(?<!`)\1(?!`)", lambda code: " " * len(code.group()), line)


def slug(heading):
    """The anchor that a heading gets where markdown is shown (GitHub's rule)."""
    text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
    text = re.sub(r"<[^>]+>", "", text).replace("`", "")
    return re.sub(r"[^\w\- ]", "", text.strip().lower()).replace(" ", "-")


def anchors_of(text):
    found, seen = set(), {}
    for _, line in prose(text):
        heading = re.match(r" {0,3}#{1,6}\s+(.*?)\s*#*$", line)
        if heading:
            name = slug(heading.group(1))
            count = seen.get(name, 0)
            seen[name] = count + 1
            found.add(f"{name}-{count}" if count else name)
        found.update(ANCHOR.findall(without_code(line)))
    return found


def links_of(text):
    """(number, target) of each link and picture; the words of a link may go on in the next line."""
    lines = [""] * len(text.splitlines())
    for number, line in prose(text):
        lines[number - 1] = without_code(line)
    whole = "\n".join(lines)
    for pattern in (LINK, TAG):
        yield from ((whole.count("\n", 0, one.end()) + 1, one.group(1)) for one in pattern.finditer(whole))


def fault_of(page, target, root):
    """Why the link on that page leads nowhere, or None."""
    if re.match(r"[a-z][a-z0-9+.-]*:", target) or target.startswith("//"):
        return None
    path, _, anchor = target.partition("#")
    path, anchor = urllib.parse.unquote(path), urllib.parse.unquote(anchor)
    if path.startswith("/"):
        return "begins with /; name it from the page"
    there = (page.parent / path).resolve() if path else page
    if not there.is_relative_to(root):
        return "leads out of the project"
    if not there.exists():
        return "there is no such file"
    if anchor and there.suffix == ".md" and anchor not in anchors_of(there.read_text(encoding="utf-8")):
        return f"no heading of {there.relative_to(root).as_posix()} has that anchor"
    return None


def check(root):
    """(faults, number of links)"""
    faults, count = [], 0
    for page in pages_of(root):
        for number, target in links_of(page.read_text(encoding="utf-8")):
            count += 1
            fault = fault_of(page, target, root)
            if fault:
                faults.append(f"{page.relative_to(root).as_posix()}:{number}: {target}: {fault}")
    return faults, count


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".").resolve()
    faults, count = check(root)
    print("\n".join(faults) if faults else f"links: no faults among {count}")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
