"""Changes files as accidents and enemies do. The same random generator, the same change."""
import re

# What terminals obey, what is no UTF-8, what editors of other systems leave behind.
PIECES = [b"\x00", b"\x07", b"\x1b[31m", b"\x1b]0;x\x07", b"\xff\xfe", b"\xc3", b"\xed\xa0\x80", b"\xef\xbb\xbf", b"\r\n",
          b"\xe2\x80\xae", b"\x7f", b"\xc2\x9b31m", b"\"", b"'", b"{", b"]", b"<", b":", b",", b"#", b"\t", b"-", b" " * 300,
          b"a" * 70000]
NUMBERS = [b"1e308", b"-1e308", b"1e400", b"nan", b"-inf", b"0", b"-0.0", b"1e-320", b"1e18", b"2147483648", b"-1", b"1e-9",
           b"18446744073709551616", b"9" * 400, b"0x10", b"1_000", b"1,5", b"\xef\xbc\x91", b"true", b"null", b"\"1\"", b"1e6",
           b"[]", b"{}", b"1e", b".", b"180deg", b"25mm", b"3m", b"1000", b"0.5.1", b"7.0000000001"]
NUMBER = re.compile(rb"(?<![\w.])-?\d+\.?\d*(?:[eE][-+]?\d+)?")
WORD = re.compile(rb"[A-Za-z_][A-Za-z_0-9]+")
KEY = re.compile(rb"\"([^\"\\]*)\"\s*:")


def spot(data, rng):
    return rng.randrange(len(data) + 1)


def piece(data, rng):
    """A stretch of it, mostly short."""
    begin = spot(data, rng)
    return begin, min(len(data), begin + int(2 ** rng.uniform(0, 9)))


def one_of(pattern, data, rng):
    found = list(pattern.finditer(data[:200000]))
    return rng.choice(found) if found else None


def put(data, begin, end, new):
    return data[:begin] + new + data[end:]


def flip_bit(data, rng):
    if not data:
        return data
    at = rng.randrange(len(data))
    return put(data, at, at + 1, bytes([data[at] ^ (1 << rng.randrange(8))]))


def cut_off(data, rng):
    return data[: spot(data, rng)]


def drop(data, rng):
    return put(data, *piece(data, rng), b"")


def repeat(data, rng):
    begin, end = piece(data, rng)
    return put(data, end, end, data[begin:end] * rng.choice([1, 1, 2, 50]))


def move(data, rng):
    begin, end = piece(data, rng)
    rest, at = data[:begin] + data[end:], spot(data, rng)
    return put(rest, at, at, data[begin:end])


def insert(data, rng):
    at = spot(data, rng)
    return put(data, at, at, rng.choice(PIECES))


def other_number(data, rng):
    found = one_of(NUMBER, data, rng)
    return put(data, *found.span(), rng.choice(NUMBERS)) if found else data


def near_number(data, rng):
    """Beside what stands there: the edge of a range, a bit too much."""
    found = one_of(NUMBER, data, rng)
    if not found:
        return data
    value = float(found.group()) * rng.choice([-1, 0.5, 1.0000001, 2, 10]) + rng.choice([0, 0, 1e-7, 1])
    return put(data, *found.span(), repr(value).encode())


def misspell(data, rng):
    found = one_of(WORD, data, rng)
    if not found:
        return data
    word, at = found.group(), rng.randrange(len(found.group()))
    ways = [word[:at] + word[at + 1 :], word[:at] + word[at : at + 1] + word[at:], word.upper(), word.replace(b"_", b""), word + b"s"]
    return put(data, *found.span(), rng.choice(ways))


def other_word(data, rng):
    a, b = one_of(WORD, data, rng), one_of(WORD, data, rng)
    return put(data, *a.span(), b.group()) if a else data


def twice(data, rng):
    """A key that stands there already, with another value."""
    found = one_of(KEY, data, rng)
    if not found:
        return data
    return put(data, found.start(), found.start(), found.group() + rng.choice([b"0", b"\"x\"", b"[0]", b"null", b"{}"]) + b",")


def same_line(data, rng):
    lines = data.splitlines(keepends=True)
    if not lines:
        return data
    line = rng.choice(lines)
    lines.insert(rng.randrange(len(lines) + 1), line)
    return b"".join(lines)


def deep(opening, closing):
    def nest(data, rng):
        at, depth = spot(data, rng), rng.choice([30, 300, 100000])
        end = closing * depth if rng.random() < 0.5 else b""
        return put(data, at, at, opening * depth + end)

    return nest


def many(item):
    """A million of the same, or fewer."""

    def fill(data, rng):
        marks = [m.end() for m in re.finditer(rb"[\[\n>]", data)] or [len(data)]
        at = rng.choice(marks)
        return put(data, at, at, item * rng.choice([2000, 100000, 1000000]))

    return fill


BYTES = [flip_bit, cut_off, drop, repeat, move, insert]
TEXT = BYTES + [other_number] * 5 + [near_number] * 4 + [misspell] * 3 + [other_word] * 2 + [same_line]
# Of each kind: what is usual, and what is big and slow.
KINDS = {
    "bytes": (BYTES, []),
    "words": (TEXT, []),
    "json": (TEXT + [twice] * 3, [deep(b"[", b"]"), deep(b"{\"a\":", b"}"), many(b"0,"), many(b"{},"), many(b"[0,0],")]),
    "lines": (TEXT + [twice] * 3, [deep(b"[", b"]"), many(b"0,"), many(b"\n"), lambda d, r: (d + b"\n") * r.choice([100, 500])]),
    "yaml": (TEXT, [deep(b"[", b"]"), deep(b"{a: ", b"}"), deep(b"- ", b""), many(b"  - wait: 1\n"), many(b"x,"),
                    lambda d, r: b"a: &a [x, x, x, x, x, x, x, x]\nb: &b [*a, *a, *a, *a, *a, *a, *a]\n" + d]),
    "xml": (TEXT, [deep(b"<body>", b"</body>"), deep(b"<link name=\"l\">", b"</link>"), many(b"<geom size='1'/>"), many(b"0 "),
                   lambda d, r: d.replace(b"<body", b"<replicate count=\"1000000\"><geom size=\"1\"/></replicate><body", 1)]),
}


def mutate(data, kind, rng):
    usual, big = KINDS[kind]
    if big and rng.random() < 0.03:
        return rng.choice(big)(data, rng)
    for _ in range(rng.choice([1, 1, 1, 2, 4])):
        data = rng.choice(usual)(data, rng)
    return data
