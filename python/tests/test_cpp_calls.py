"""Every public C++ function of the rooms that people call has a Python name, or a reason why it has none."""

import pathlib
import re

import pytest

import mjarm

HERE = pathlib.Path(__file__).parent
ROOMS = ("kinematics", "path", "planning", "trajectory", "identification", "execution", "program", "perception")
EVERYWHERE = {"name", "describe", "word"}  # of enumerations and failures: attributes and texts of exceptions


def functions_of(header):
    """Names of the functions that a header declares outside of classes."""
    text = re.sub(r"//[^\n]*|#[^\n]*|^inline constexpr[^;]*;|^using[^;]*;", "", header, flags=re.MULTILINE)
    found, words, inside = set(), "", []
    for letter in text:
        if letter in "{;" and not any(inside):
            call = re.search(r"(\w+)\s*\(", words)
            if call and not re.match(r"\s*(enum|class|struct)\b", words):
                found.add(call.group(1))
        if letter == "{":
            inside.append(not re.match(r"\s*(inline\s+)?namespace\b", words))
        elif letter == "}" and inside:
            inside.pop()
        words = "" if letter in "{};" else words + letter
    return found


def named():
    table = {}
    for line in (HERE / "cpp_calls.txt").read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            name, said = line.split(None, 1)
            assert name not in table, f"{name} stands twice"
            table[name] = said
    return table


def test_every_function_is_in_the_table():
    root = HERE.parents[1] / "mjarm"
    headers = [file for room in ROOMS for file in (root / room).glob("*.hpp") if not re.search("_(internal|test)$", file.stem)]
    assert len(headers) > 60
    text = {file: file.read_text(encoding="utf-8") for file in headers}
    declared = set().union(*map(functions_of, text.values())) - EVERYWHERE
    assert len(declared) > 120
    table = named()
    assert sorted(declared - set(table)) == [], "these need a Python name, or a reason"
    words = set(re.findall(r"\w+", " ".join(text.values())))
    assert sorted(set(table) - words) == [], "these are no longer there"


@pytest.mark.parametrize("name, said", [pair for pair in named().items() if not pair[1].startswith("- ")])
def test_the_name_is_there(name, said):
    thing = mjarm
    for part in said.split("."):
        thing = getattr(thing, part)
    assert thing.__doc__, said


def test_a_missing_one_would_be_seen():
    found = functions_of("namespace a {\n[[nodiscard]] int first(int x);\nclass B { void hidden(); };\ninline int second() { return 1; }\n}")
    assert found == {"first", "second"}
