"""Pages of the C++ interface from the public headers: each declaration as it stands there, below what its comment says."""

import re

TEXTS = {
    "core": "values, errors, poses, files, words", "model": "MJCF and URDF to a robot; what is wrong with a file",
    "kinematics": "where the tool is, and joint values for it", "collision": "spheres, exact distances, proofs of edges",
    "path": "curves without time, and joints along them", "planning": "paths round obstacles, and their proof",
    "trajectory": "motions in time within limits", "control": "from a reference to commands of actuators",
    "identification": "payload, friction and links from a log",
    "teleop": "leading an arm by velocities of its tool",
    "sim": "MuJoCo steps, with a controller", "render": "pictures and films", "perception": "objects that a camera sees",
    "execution": "motions run and measured", "program": "motion programs", "episode": "recorded demonstrations",
    "view": "the window", "serve": "the page in a browser",
    "rl": "learning to reach", "clone": "policies from demonstrations", "install": "real meshes", "session": "what every face of the program shares",
}


def public_headers(root, room):
    for file in sorted((root / "mjarm" / room).rglob("*.hpp")):
        if not re.search(r"_(internal|test)\.hpp$", file.name) and file.parent.name not in ("simd", "messages"):
            yield file


def without_literals(line):
    """For counting brackets: no strings, characters or comments."""
    return re.sub(r'"(?:\\.|[^"\\])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\])\'|//.*$', "", line)


def items(text):
    """(comment, declaration) of all that a header declares within its namespaces, in order; the comment may be empty."""
    comment, code, depth, found, wants_comment = [], [], 0, [], True
    for line in text.splitlines():
        bare = line.strip()
        if not code and (not bare or bare.startswith("#") or re.match(r"(inline )?namespace\b.*\{$", bare) or re.match(r"\}\s*(//.*)?$", bare)):
            if not bare and comment and comment[0].startswith("// "):
                comment = []  # a remark between declarations
            continue
        if not code and bare.startswith("//"):
            comment.append(bare)
            continue
        code.append(line)
        counted = without_literals(line)
        depth += sum(counted.count(one) for one in "({[") - sum(counted.count(one) for one in ")}]")
        end = counted.rstrip()
        if re.fullmatch(r"(class|struct|enum class) \w+;", end):  # named here, declared elsewhere
            comment, code = [], []
        elif depth == 0 and (end.endswith(";") or (end.endswith("}") and not begins_type("\n".join(code)))):
            found.append((comment, code))
            comment, code = [], []
    return found


def begins_type(code):
    return bool(re.match(r"(template\s*<.*>\s*)?(class|struct|enum|union)\b", code.lstrip()))


def declaration(code):
    """Without bodies of functions and without what is private."""
    text = "\n".join(code)
    if begins_type(text):
        text = re.sub(r"\n private:.*?(?=\n(?: public:|\};))", "", text, flags=re.S).replace("\n\n};", "\n};")
    else:
        text = re.sub(r"\)([^{};]*?)\s*\{.*\}\s*$", r")\1;", text, flags=re.S) if "(" in text.split("{")[0] and "{" in text else text
    return text


def prose(comment):
    """What a comment says, in markdown."""
    out = []
    # What is no code in markdown must not become some: names with underscores, brackets and stars.
    escaped = re.sub(r"(`[^`]*`)|([<>*_\[\]$#|])", lambda one: one.group(1) or "\\" + one.group(2),
                     "\n".join(re.sub(r"^///?<?\s?", "", line) for line in comment))
    for text in escaped.splitlines():
        named = re.match(r"@(param|tparam)(?:\[\w+\])?\s+(\S+)\s*(.*)", text)
        back = re.match(r"@(?:return|returns)\s*(.*)", text)
        if named:
            out += ["", "- `{}` — {}".format(named.group(2).replace("\\", ""), named.group(3))]
        elif back:
            out += ["", f"- *returns* {back.group(1)}"]
        else:
            goes_on = any(line.startswith(("- `", "- *returns*")) for line in out) and not text.startswith("- ")
            out.append(("  " if goes_on and text else "") + text)
    return "\n".join(out)


def name_of(code):
    text = without_template(" ".join(line.strip() for line in code if not line.strip().startswith("//")))
    value = re.match(r"[^({=]*?(\w+)\s*=[^=]", text)
    if value and not re.match(r"using\b|enum\b|struct\b|class\b|.*\boperator\b", text):
        return value.group(1)
    for pattern in (r"(?:class|struct|union|enum class|enum)\s+(?:\[\[\w+\]\]\s*|alignas\([^)]*\)\s*)?([\w:]+)", r"using\s+(\w+)\s*=", r"(operator\s*[^\s(]+)\s*\(",
                    r"([\w:~]+)\s*\(", r"([\w:]+)\s*(?:\[.*?\])?\s*(?:=|\{|;)"):
        found = re.search(pattern, re.sub(r"\[\[.*?\]\]\s*", "", text)) if "enum" not in pattern else re.match(pattern, text)
        if found:
            return found.group(1)
    return text[:40]


def without_template(text):
    while text.startswith("template"):
        depth, at = 0, text.index("<")
        for at in range(at, len(text)):
            depth += (text[at] == "<") - (text[at] == ">")
            if not depth:
                break
        text = re.sub(r"^requires\s+[^{;]*?\s(?=\w)", "", text[at + 1:].lstrip())
    return text


def header_section(path, text):
    """One header: what each declaration is for, and how it is written. Overloads with one comment stay together."""
    out, shown, groups = [f"## {path.removeprefix('mjarm/')}\n", f"```cpp\n#include <{path}>\n```\n"], "", []
    for comment, code in items(text):
        if comment or not groups or begins_type("\n".join(code)) or begins_type("\n".join(groups[-1][1][0])):
            groups.append((comment, [code]))
        else:
            groups[-1][1].append(code)
    for comment, codes in groups:
        name = name_of(codes[0])
        if name != shown:
            out.append(f"### `{name}`\n")
        shown = name
        if comment:
            out.append(prose(comment) + "\n")
        out.append("```cpp\n" + "\n".join(declaration(code) for code in codes) + "\n```\n")
    return "\n".join(out) if groups else ""


def write_pages(root, folder, rooms):
    """A page a room, with a section a header."""
    lines = ["# C++ interface\n", "By room, in the order in which data flows: a room knows those above it alone. "
             "All is in the namespace `mjarm`; units are SI.\n", "| room | what is in it |", "|---|---|"]
    lines += [f"| [{room}]({room}.md) | {TEXTS[room]} |" for room in rooms]
    lines += ["\n```{toctree}\n:hidden:\n", *rooms, "```\n"]
    folder.mkdir(parents=True)
    (folder / "index.md").write_text("\n".join(lines), encoding="utf-8")
    for room in rooms:
        out = [f"# mjarm/{room}\n", TEXTS[room][0].upper() + TEXTS[room][1:] + ".\n"]
        for file in public_headers(root, room):
            out.append(header_section(file.relative_to(root).as_posix(), file.read_text(encoding="utf-8")))
        (folder / f"{room}.md").write_text("\n".join(out), encoding="utf-8")
