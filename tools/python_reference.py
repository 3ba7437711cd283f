"""Writes docs/python.md, the reference of the package of Python, from its docstrings, and docs/python.zh-CN.md beside it.

Usage: python_reference.py STUB PAGE, the stub being mjarm/_core.pyi of a build or of an installed package. The Chinese is that of
python/docs/zh-CN.txt; a docstring without any, or Chinese of what no docstring says any more, is told a line each: exit code 1.
"""

import ast
import inspect
import pathlib
import re
import sys

import catalogue

ROOT = pathlib.Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "python" / "mjarm"
CATALOGUE = ROOT / "python" / "docs" / "zh-CN.txt"
HEAD = """# Python: reference

[中文](python.zh-CN.md)

Made from the docstrings by `tools/python_reference.py`. Units are SI; `Array` is a float64 array of numpy, `PoseLike` a `Pose` or an array (4, 4), `PosesLike` a
list of those, an array (n, 4, 4) or a pair of positions (n, 3) and quaternions (n, 4). How things are used: [python/README.md](../python/README.md),
[python/examples](../python/examples).
"""
ITEM = re.compile(r"(- `[^`]+`)(?: \((.*?)\)(?=:|$))?(?:: (.*))?")


class Docstrings(catalogue.Catalogue):
    """A piece is a paragraph, an item of a list, the type of an item, or a comment in an example."""

    def __call__(self, name, doc):
        """A docstring, as doc_of() made it, in Chinese: the same lists and the same code."""
        blocks = re.split(r"(\n\s*\n|\n(?=- ))", doc)
        return "".join(block if not block.strip() else self.block(name, block) for block in blocks)

    def block(self, name, text):
        if text.startswith("    "):
            return re.sub(r"# (.+)", lambda comment: f"# {self.piece(name, comment[1])}", text)
        item = ITEM.fullmatch(text)
        if not item:
            return self.piece(name, " ".join(text.split()))
        head, kind, words = item.groups()
        return head + (f"（{self.piece(name, kind)}）" if kind else "") + (f"：{self.piece(name, words)}" if words else "")


def as_it_is(_, doc):
    return doc


def doc_of(node):
    """With the sections of numpy's form as lists, and what Python is asked as code."""
    lines = inspect.cleandoc(ast.get_docstring(node, clean=False) or "").splitlines()
    out, inside = [], False
    for i, line in enumerate(lines):
        if re.fullmatch("-{3,}", line):
            continue
        if i + 1 < len(lines) and re.fullmatch("-{3,}", lines[i + 1]):
            inside = True
            out += [f"{line}:", ""]
        elif inside and line and not line.startswith(" "):
            name, _, kind = line.partition(" : ")
            out.append(f"- `{name}`" + (f" ({kind})" if kind else ""))
        elif inside and line:
            out[-1] += (": " if out[-1].endswith((")", "`")) else " ") + line.strip()
        else:
            out.append(f"    {line}" if line.startswith((">>> ", "... ")) else line)
    return "\n".join(out)


def decorators(node):
    return {ast.unparse(one) for one in node.decorator_list}


def signature(node, owner=None):
    """As it is called: without self, on one line."""
    arguments = ast.unparse(node.args)
    if owner and "staticmethod" not in decorators(node):
        arguments = re.sub(r"^(self|cls)(, /)?(, )?", "", arguments)
    result = f" -> {ast.unparse(node.returns)}" if node.returns and node.name != "__init__" else ""
    name = owner if node.name == "__init__" else node.name
    return f"{name}({arguments}){result}".replace("'", '"')


def entry(head, doc):
    lines = doc.splitlines() or [""]
    body = "\n".join(f"  {line}".rstrip() for line in lines[1:])
    return f"- `{head}` {lines[0]}\n" + (f"{body}\n" if body.strip() else "")


def describe_class(node, say):
    out = [f"\n### {node.name}\n\n{say(node.name, doc_of(node))}\n\n"]
    seen = set()
    for one in node.body:
        if isinstance(one, ast.AnnAssign | ast.Assign):
            names = [ast.unparse(target) for target in (one.targets if isinstance(one, ast.Assign) else [one.target])]
            out += [f"- `{name}`\n" for name in names if not name.startswith("_")]
        if not isinstance(one, ast.FunctionDef) or (one.name.startswith("_") and one.name != "__init__"):
            continue
        marks = decorators(one)
        if any(mark.endswith(".setter") for mark in marks) or (one.name, ast.unparse(one.args)) in seen:
            continue
        seen.add((one.name, ast.unparse(one.args)))
        doc = say(f"{node.name}.{one.name}", doc_of(one))
        if "property" in marks:
            out.append(entry(f"{one.name}: {ast.unparse(one.returns)}", doc))
        elif one.name != "__init__" or doc or one.args.args[1:] or one.args.kwonlyargs:
            out.append(entry(signature(one, node.name), doc))
    return "".join(out)


def describe_module(source, say, public=None):
    tree = ast.parse(source)
    functions, classes = [], []
    for node in tree.body:
        if isinstance(node, ast.ClassDef | ast.FunctionDef) and (node.name in public if public else not node.name.startswith("_")):
            (classes if isinstance(node, ast.ClassDef) else functions).append(node)
    out = [entry(signature(node), say(node.name, doc_of(node))) for node in functions]
    return "".join(out) + "".join(describe_class(node, say) for node in sorted(classes, key=lambda node: node.name != "Robot"))


def public_names(package=PACKAGE):
    tree = ast.parse((package / "__init__.py").read_text(encoding="utf-8"))
    names = next(node.value for node in tree.body if isinstance(node, ast.Assign) and node.targets[0].id == "__all__")
    return {name.value for name in names.elts}


def page(stub, say=as_it_is):
    """The page, with what `say` makes of a name and its docstring."""
    parts = [say("page", HEAD), "\n\n## mjarm\n\n", describe_module(stub.read_text(encoding="utf-8"), say, public_names())]
    for name in ("errors", "ikpy", "gym", "tasks"):
        source = (PACKAGE / f"{name}.py").read_text(encoding="utf-8")
        parts += [f"\n## mjarm.{name}\n\n{say(f'mjarm.{name}', doc_of(ast.parse(source)))}\n\n", describe_module(source, say)]
    data = PACKAGE / "data"
    parts += ["\n## mjarm.data\n\n", say("mjarm.data", doc_of(ast.parse((data / "__init__.py").read_text(encoding="utf-8")))), "\n\n"]
    for name in ("lerobot", "robomimic", "mcap"):
        parts.append(describe_module((data / f"{name}.py").read_text(encoding="utf-8"), say, public_names(data)))
    return re.sub(r"\n{3,}", "\n\n", "".join(parts)).rstrip() + "\n"


def docstrings():
    return Docstrings(CATALOGUE.read_text(encoding="utf-8"), CATALOGUE.relative_to(ROOT).as_posix())


def main(stub, english):
    english.write_text(page(stub), encoding="utf-8")
    chinese = docstrings()
    text = page(stub, chinese)
    if faults := chinese.all_faults():
        sys.exit("\n".join(faults))
    english.with_suffix(".zh-CN.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*map(pathlib.Path, sys.argv[1:]))
