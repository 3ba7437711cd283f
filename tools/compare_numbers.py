"""Compares two texts whose numbers may differ a little.

Usage: compare_numbers.py ONE OTHER [--within 1e-9] [--ignore KEY]...
Words must be equal and numbers as near as that, absolute or relative to the larger; in a table the quaternions
(columns that end in qw, qx, qy, qz) may have either sign. A line that holds an ignored KEY (a measured time) is not
compared. Prints the largest difference, or the first line that differs; exit code 1 then.
"""

import argparse
import pathlib
import re
import sys

NUMBER = re.compile(r"(?<![A-Za-z_])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")


def difference(one, other):
    """Of two numbers, absolute or relative to the larger, whichever is less."""
    return abs(one - other) / max(1.0, abs(one), abs(other))


def lines_of(text, ignored):
    # Paths of Windows have backslashes.
    return [line.rstrip("\r").replace("\\\\", "/").replace("\\", "/")
            for line in text.split("\n") if not any(key in line for key in ignored)]


def turned_alike(one, other):
    """Lines of `other`, a table, with the signs that the quaternions of `one` have: q and -q are one rotation."""
    header = one[0].split(",")
    starts = [i for i, name in enumerate(header) if name.endswith(" qw")]
    lines = other[:1]
    for a, b in zip(one[1:], other[1:]):
        x, y = a.split(","), b.split(",")
        for i in starts if len(x) == len(y) == len(header) else ():
            if sum(float(x[k]) * float(y[k]) for k in range(i, i + 4)) < 0:
                y[i:i + 4] = [repr(-float(value)) for value in y[i:i + 4]]
        lines.append(",".join(y))
    return lines + other[len(lines):]


def compare(one, other, within, ignored=()):
    """The largest difference of numbers, and the first fault as a line or None."""
    largest = 0.0
    first, second = lines_of(one, ignored), lines_of(other, ignored)
    if " qw," in first[0]:
        second = turned_alike(first, second)
    if len(first) != len(second):
        return largest, f"{len(first)} lines and {len(second)} lines"
    for number, (a, b) in enumerate(zip(first, second), 1):
        if NUMBER.sub("#", a) != NUMBER.sub("#", b):
            return largest, f"line {number}: {a!r} and {b!r}"
        for x, y in zip(NUMBER.findall(a), NUMBER.findall(b)):
            apart = difference(float(x), float(y))
            largest = max(largest, apart)
            if apart > within:
                return largest, f"line {number}: {x} and {y}"
    return largest, None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("one", type=pathlib.Path)
    parser.add_argument("other", type=pathlib.Path)
    parser.add_argument("--within", type=float, default=1e-9)
    parser.add_argument("--ignore", action="append", default=[])
    args = parser.parse_args()
    texts = [file.read_text(encoding="utf-8") for file in (args.one, args.other)]
    largest, fault = compare(*texts, args.within, args.ignore)
    if fault:
        print(f"{args.one}, {args.other}: {fault}")
        sys.exit(1)
    print(f"{args.other.name}: numbers differ by at most {largest:.2g}")


if __name__ == "__main__":
    main()
