"""Reads a JUnit file of ctest or pytest: says what failed and what was skipped and why.

Usage: test_summary.py FILE. The last line printed is "PASSED FAILED SKIPPED", three numbers.
"""

import collections
import re
import sys
import xml.etree.ElementTree as ElementTree

CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f]")  # XML has none; colours of terminals begin with one


def skip_reason(case):
    """The message a skipped GoogleTest gave, else what ctest says."""
    output = case.findtext("system-out") or ""
    found = re.search(r"Skipped\n(.+)", output)
    if found:
        return found.group(1).split(";")[0].strip()  # what follows differs from test to test
    skipped = case.find("skipped")
    return (skipped.get("message") if skipped is not None else "") or "no reason given"


def status_of(case):
    """What ctest calls it; pytest has elements instead."""
    if case.get("status"):
        return case.get("status")
    if case.find("failure") is not None or case.find("error") is not None:
        return "fail"
    return "run" if case.find("skipped") is None else "notrun"


def main(path):
    failed, skipped, passed = [], collections.defaultdict(list), 0
    with open(path, encoding="utf-8", errors="replace") as file:
        text = CONTROL.sub("", file.read())
    for case in ElementTree.fromstring(text).iter("testcase"):
        status = status_of(case)
        if status == "run":
            passed += 1
        elif status == "fail":
            failed.append(case.get("name"))
        else:
            skipped[skip_reason(case)].append(case.get("name"))
    for reason, names in sorted(skipped.items()):
        print(f"SKIPPED: {len(names)} ({names[0]}{', ...' if names[1:] else ''}): {reason}")
    for name in failed:
        print(f"FAILED: {name}")
    print(passed, len(failed), sum(len(names) for names in skipped.values()))


if __name__ == "__main__":
    main(sys.argv[1])
