"""Pages of the C++ interface from the public headers: each declaration as it stands there, below what its comment says."""

import re

import catalogue

TEXTS = {  # of each room, in English and in Chinese
    "core": ("values, errors, poses, files, words", "数值、错误、位姿、文件与文字"),
    "model": ("MJCF and URDF to a robot; what is wrong with a file", "由 MJCF 与 URDF 得到机器人；文件有什么毛病"),
    "kinematics": ("where the tool is, and joint values for it", "工具在哪里，以及到达它的关节值"),
    "collision": ("spheres, exact distances, proofs of edges", "球近似、精确距离、边的无碰撞证明"),
    "path": ("curves without time, and joints along them", "不含时间的曲线，以及沿曲线的关节值"),
    "planning": ("paths round obstacles, and their proof", "绕开障碍的路径及其证明"),
    "trajectory": ("motions in time within limits", "满足限值的时间轨迹"),
    "control": ("from a reference to commands of actuators", "由参考轨迹到执行器指令"),
    "identification": ("payload, friction and links from a log", "由记录辨识负载、摩擦与连杆参数"),
    "teleop": ("leading an arm by velocities of its tool", "用工具速度牵引机械臂"),
    "sim": ("MuJoCo steps, with a controller", "带控制器的 MuJoCo 步进"),
    "render": ("pictures and films", "图片与视频"),
    "perception": ("objects that a camera sees", "相机看到的物体"),
    "execution": ("motions run and measured", "运动的执行与测量"),
    "program": ("motion programs", "运动程序"),
    "episode": ("recorded demonstrations", "录制的示范数据"),
    "view": ("the window", "窗口"),
    "serve": ("the page in a browser", "浏览器页面"),
    "rl": ("learning to reach", "学习到达"),
    "clone": ("policies from demonstrations", "由示范数据得到策略"),
    "install": ("real meshes", "真实网格"),
    "session": ("what every face of the program shares", "程序各界面共用的部分"),
}
WORDS = {
    "en": {"title": "C++ interface", "room": "room", "what": "what is in it", "returns": "returns", "stop": ".",
           "order": "By room, in the order in which data flows: a room knows those above it alone. All is in the namespace `mjarm`; units are SI."},
    "zh-CN": {"title": "C++ 接口", "room": "模块", "what": "内容", "returns": "返回", "stop": "。",
              "order": "按模块列出，顺序即数据的流向：每个模块只依赖列在它上面的模块。全部在命名空间 `mjarm` 里；单位为国际单位制。"},
}
COMMENT = re.compile(r'((?:"(?:\\.|[^"\\])*"|[^"/]|/(?!/))*?)(//[/!]?<?)(.*)')

# The end of a function's head, with what a constructor puts into members, and the bracket that opens its body.
BODY = re.compile(r"(\)(?:\s*(?:const|noexcept|override|final|&&?|->[^{;]*?))*)(?:\s*:(?!:)[^;]*?[)}])?\s\{", re.S)


class Chinese:
    """What the comments of a room say in Chinese, from docs/cpp/ROOM.zh-CN.txt: a section a header, a paragraph a piece."""

    def __init__(self, root, room):
        file = root / "docs" / "cpp" / f"{room}.zh-CN.txt"
        self.catalogue = catalogue.Catalogue(file.read_text(encoding="utf-8") if file.exists() else "", file.relative_to(root).as_posix())

    def of(self, header):
        """What says a paragraph of that header; one without words, as a unit or a shape, stays as it is."""
        return lambda text: self.catalogue.piece(header, text) if has_words(text) else text


def has_words(text):
    return re.search("[A-Za-z]{2}", re.sub(r"`[^`]*`|\[[^\]]*\]|\([^()]*,[^()]*\)", "", text)) is not None


def public_headers(root, room):
    for file in sorted((root / "mjarm" / room).rglob("*.hpp")):
        if not re.search(r"_(internal|test)\.hpp$", file.name) and file.parent.name not in ("simd", "messages"):
            yield file


def without_literals(line):
    """For counting brackets: no strings, characters or comments."""
    return re.sub(r'"(?:\\.|[^"\\])*"|(?<![0-9a-fA-F])\'(?:\\.|[^\'\\])\'|//.*$', "", line)


def items(text):
    """(comment, declaration) of all that a header declares within its namespaces, in order; one of both may be empty."""
    comment, code, depth, found = [], [], 0, []
    for line in text.splitlines():
        bare = line.strip()
        if not code and (not bare or bare.startswith("#") or re.match(r"(inline )?namespace\b.*\{$", bare) or re.match(r"\}\s*(//.*)?$", bare)):
            if comment and (not bare or "namespace" in bare):  # of no declaration: a remark, or what holds for all that follow
                found += [] if comment[0].startswith("// ") else [(comment, [])]
                comment = []
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


def declaration(code, say=None):
    """Without bodies of functions and without what is private."""
    text = "\n".join(code)
    if begins_type(text):
        text = without_bodies(re.sub(r"\n private:.*?(?=\n(?: public:|\};))", "", text, flags=re.S)).replace("\n\n};", "\n};")
    else:
        text = re.sub(r"\)([^{};]*?)\s*\{.*\}\s*$", r")\1;", text, flags=re.S) if "(" in text.split("{")[0] and "{" in text else text
    return commented(text, say) if say else text


def without_bodies(text):
    """A type whose functions are only declared: without their bodies, and without what constructors put into members."""
    seen = re.sub(r'"(?:\\.|[^"\\])*"|//[^\n]*', lambda one: " " * len(one[0]), text)  # as long, without strings and comments
    out, at = [], 0
    while head := BODY.search(seen, at):
        depth, end = 1, head.end()
        while depth:
            depth += (seen[end] == "{") - (seen[end] == "}")
            end += 1
        out += [text[at:head.end(1)], ";"]
        at = end
    return "".join(out) + text[at:]


def commented(text, say):
    """A declaration with its comments as `say` has them, a line a paragraph."""
    out, run = [], None  # run: what stands before the comment, its mark, its lines
    for line in [*text.splitlines(), ""]:
        found = COMMENT.fullmatch(line)
        before, mark, words = found.groups() if found else (line, "", "")
        if run and found and mark == run[1] and not before.strip():
            run[2].append(words)
            continue
        if run:
            said = [" ".join(filter(None, ("  " if kind == "code" else kind, say(piece)))) for kind, piece in pieces(run[2])]
            at_end = bool(run[0].strip())
            out += [f"{run[0]}{run[1]} {one}" for one in ([" ".join(said)] if at_end else said)]
        run = (before, mark, [words]) if found else None
        if not found:
            out.append(line)
    return "\n".join(out[:-1])


def pieces(lines):
    """(mark, text) of each paragraph of a comment without its slashes; the mark is empty, "-", "|" (a row of a table), "code", "@param NAMES" or
    "@return"."""
    found = [None]
    for line in lines:
        for text in re.split(r"(?<=\s)(?=@(?:t?param|returns?)\b)", line):
            mark = re.match(r"\s*(@t?param(?:\[\w+\])?\s+\w+(?:,\s?\w+)*|@returns?|@file|-(?=\s)|\|)\s*(.*)$", text)
            if re.match(r" {3,}\S", text) and (not found[-1] or found[-1][0] in ("", "code")):
                found.append(["code", text.strip()])
            elif mark and not text.startswith("  "):
                found.append([mark[1], mark[2].strip()])
            elif not text.strip() or not found[-1] or found[-1][0] in ("code", "|"):
                found.append(["", text.strip()] if text.strip() else None)
            else:
                found[-1][1] += " " + text.strip()
    return [(mark, text.strip()) for mark, text in filter(None, found) if text and not text.startswith("NOLINT")]


def prose(comment, say=None):
    """What a comment says, in markdown."""
    out, before, returns = [], None, WORDS["zh-CN" if say else "en"]["returns"]
    say = say or (lambda text: text)
    for mark, text in pieces(re.sub(r"^///?<?", "", line) for line in comment):
        if mark == "code":
            text = re.sub(r"(?<=// )(.*)", lambda words: say(words[1]), text)
            out += [f"    {text}"] if before == mark else ["", f"    {text}"]
        elif mark == "|":
            out += [*([""] if before != mark else []), f"| {say(text)}"]
        else:
            # What is no code in markdown must not become some: names with underscores, brackets and stars.
            said = re.sub(r"(`[^`]*`)|([<>*_\[\]$#|])", lambda one: one.group(1) or "\\" + one.group(2), say(text))
            if mark.startswith("@return"):
                said = f"- *{returns}* {said}"
            elif mark.startswith(("@param", "@tparam")):
                said = f"- `{mark.split(maxsplit=1)[1]}` — {said}"
            elif mark == "-":
                said = f"- {said}"
            out += ["", said]
        before = mark
    return "\n".join(out[1:])


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


def header_section(path, text, say=None):
    """One header: what each declaration is for, and how it is written. Overloads with one comment stay together."""
    out, shown, groups = [f"## {path.removeprefix('mjarm/')}\n", f"```cpp\n#include <{path}>\n```\n"], "", []
    for comment, code in items(text):
        if not code:
            groups.append((comment, []))
        elif comment or not groups or not groups[-1][1] or begins_type("\n".join(code)) or begins_type("\n".join(groups[-1][1][0])):
            groups.append((comment, [code]))
        else:
            groups[-1][1].append(code)
    for comment, codes in groups:
        name = name_of(codes[0]) if codes else shown
        if name != shown:
            out.append(f"### `{name}`\n")
        shown = name
        if comment:
            out.append(prose(comment, say) + "\n")
        if codes:
            out.append("```cpp\n" + "\n".join(declaration(code, say) for code in codes) + "\n```\n")
    return "\n".join(out) if any(codes for _, codes in groups) else ""


def room_page(root, room, language):
    """(page, faults): a section a header; a fault is a comment without Chinese, or Chinese of none."""
    text = TEXTS[room][language != "en"]
    out = [f"# mjarm/{room}\n", text[0].upper() + text[1:] + WORDS[language]["stop"] + "\n"]
    chinese = Chinese(root, room) if language != "en" else None
    for file in public_headers(root, room):
        out.append(header_section(file.relative_to(root).as_posix(), file.read_text(encoding="utf-8"), chinese and chinese.of(file.name)))
    return "\n".join(out), chinese.catalogue.all_faults() if chinese else []


def write_pages(root, folder, rooms, language):
    """A page a room."""
    words = WORDS[language]
    lines = [f"# {words['title']}\n", f"{words['order']}\n", f"| {words['room']} | {words['what']} |", "|---|---|"]
    lines += [f"| [{room}]({room}.md) | {TEXTS[room][language != 'en']} |" for room in rooms]
    lines += ["\n```{toctree}\n:hidden:\n", *rooms, "```\n"]
    folder.mkdir(parents=True)
    (folder / "index.md").write_text("\n".join(lines), encoding="utf-8")
    for room in rooms:
        (folder / f"{room}.md").write_text(room_page(root, room, language)[0], encoding="utf-8")
