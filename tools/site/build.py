"""Writes the site of mjarm: all pages in two languages, what the program says about its commands, and the C++ interface.

Usage: build.py --program MJARM --out FOLDER. The site is OUT/index.html; it opens from disk and needs no network.
Sphinx with the theme furo makes it; a warning fails. Then every link is followed, and nothing may be loaded from elsewhere.
"""

import argparse
import html.parser
import os
import pathlib
import re
import shutil
import subprocess
import sys
import urllib.parse

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))

import check_layers  # noqa: E402
import check_links  # noqa: E402
import cpp_api  # noqa: E402

LANGUAGES = {"en": "C.UTF-8", "zh-CN": "zh_CN.UTF-8"}

# The parts of the site and their pages, in order, without .md; a name ending in * stands for all such pages.
PARTS = [
    ({"en": "Begin", "zh-CN": "入门"}, ["docs/tutorial_steps", "docs/learn/README", "docs/learn/0*"]),
    ({"en": "Use", "zh-CN": "使用"}, ["docs/programs", "docs/identify", "docs/planning", "docs/perception", "docs/viewing", "docs/serve", "docs/learning", "docs/teleop", "docs/data"]),
    ({"en": "In programs", "zh-CN": "编程"}, ["python/README", "docs/python", "python/lerobot_env_mjarm/README", "api/index"]),
    ({"en": "Reference", "zh-CN": "参考"}, ["commands/index", "docs/files", "docs/conventions", "docs/troubleshooting", "docs/windows", "messages", "models/README", "docs/benchmarks"]),
    ({"en": "Project", "zh-CN": "项目"}, ["docs/architecture", "CONTRIBUTING", "web/README", "CHANGELOG"]),
]
THEME_IN_CHINESE = {
    r"(>\s*)On this page(\s*<)": r"\1本页内容\2", r"(>\s*)Next(\s*<)": r"\1下一页\2", r"(>\s*)Previous(\s*<)": r"\1上一页\2", r"(>\s*)Home(\s*<)": r"\1首页\2",
    r"Back to top": "回到顶部", r"(>\s*)Made with": r"\1制作工具：", r"Search finished, found \$\{resultCount\} page\(s\) matching the search query\.":
    "共找到 ${resultCount} 个页面。",
}
WORDS = {
    "en": {"commands": "Commands", "commands_text": "What the program says about itself: `mjarm COMMAND --help`.",
           "messages": "Messages", "messages_text": "All that the library and the program may say, by topic; `{}` stands for what a message is about. "
           "What to do about the most frequent ones: [Troubleshooting](docs/troubleshooting.md)."},
    "zh-CN": {"commands": "命令", "commands_text": "程序对自身的说明：`mjarm 命令 --help`。",
              "messages": "提示与报错", "messages_text": "程序和库可能给出的全部文字，按主题排列；`{}` 处是具体内容。常见问题的原因和解决办法见[排错](docs/troubleshooting.md)。"},
}


def pages(names=tuple(name for _, part in PARTS for name in part)):
    """The pages of the project that have these names, in their order."""
    found = [file.relative_to(ROOT).as_posix()[:-3] for name in names for file in sorted(ROOT.glob(f"{name}.md"))]
    return [name for name in found if not name.endswith(".zh-CN")]


def source_of(name, language):
    return ROOT / (f"{name}.md" if language == "en" else f"{name}.{language}.md")


def without_blanks_in_chinese(text):
    """A line that ends in Chinese goes on in the next one; a browser would show a blank there."""
    wide = r"[\u3000-\u303f\u4e00-\u9fff\uff00-\uffef]"
    return re.sub(rf"(?m)^(?!#)(.*{wide})\n(?=[`\[*]*{wide})", r"\1", text)


class Stage:
    """The pages of one language, as Sphinx reads them."""

    def __init__(self, language, work, out):
        self.language, self.work, self.out = language, work, out
        self.names = {"README", *pages()}

    def write(self, name, text):
        path = self.work / f"{name}.md"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def page(self, name):
        """Copies a page, with its links as they are in the site."""
        file = source_of(name, self.language)
        text = file.read_text(encoding="utf-8")
        out = [line.replace("```mermaid", "```text") if line.startswith("```") else line for line in text.splitlines()]
        for number, _ in check_links.prose(text):
            out[number - 1] = self.with_links(out[number - 1], file, name)
        return without_blanks_in_chinese("\n".join(out)) + "\n"

    def with_links(self, line, file, name):
        kept = check_links.without_code(line)
        for found in reversed(list(re.finditer(r"(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^()\s]+)\)", kept))):
            words, target = line[found.start(2):found.end(2)], found.group(3)
            if not re.match(r"[a-z]+:|#", target):
                line = line[:found.start()] + self.link(found.group(1), words, target, file, name) + line[found.end():]
        up = "../" * name.count("/") + "../"
        return re.sub(r"<img src=\"([^\":]+)\"", lambda one: f'<img src="{up}{self.shown((file.parent / one.group(1)).resolve())}"', line)

    def link(self, mark, words, target, file, name):
        """A link of a page, as markdown or, where it leads out of what Sphinx knows, as HTML."""
        path, _, anchor = target.partition("#")
        there = (file.parent / urllib.parse.unquote(path)).resolve()
        anchor = f"#{anchor}" if anchor else ""
        if mark:
            self.picture(there)
            return f"![{words}]({target})"
        up = "../" * name.count("/")
        page = there.relative_to(ROOT).as_posix().removesuffix(".md")
        language = "zh-CN" if page.endswith(".zh-CN") else "en"
        page = page.removesuffix(".zh-CN")
        if there.suffix == ".md" and page in self.names:
            staged = "index" if page == "README" else page
            if language == self.language:
                return f"[{words}]({up}{staged}.md{anchor})"
            return f'<a href="{up}../{language}/{staged}.html{urllib.parse.quote(anchor, safe="#%")}">{words}</a>'
        return f'<a href="{up}../{self.copied(there)}">{words}</a>'

    def picture(self, file):
        copy = self.work / file.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(file, copy)

    def shown(self, there):
        """Where the site holds a picture that a page shows by HTML."""
        copy = self.out / "files" / there.relative_to(ROOT)
        copy.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(there, copy)
        return copy.relative_to(self.out).as_posix()

    def copied(self, there):
        """Where the site holds a file or a folder of the project that is no page: as text, which any browser shows."""
        path = f"files/{there.relative_to(ROOT).as_posix()}"
        (self.out / path).parent.mkdir(parents=True, exist_ok=True)
        if there.is_dir():
            names = sorted(one.name + "/" * one.is_dir() for one in there.iterdir() if not one.name.startswith((".", "__")))
            (self.out / path).mkdir(exist_ok=True)
            (self.out / path / "index.html").write_text("<!doctype html><meta charset=utf-8><title>{0}</title><h1>{0}</h1><pre>{1}</pre>".format(
                there.relative_to(ROOT).as_posix(), "\n".join(self.listed(there / name) for name in names)), encoding="utf-8")
            return f"{path}/index.html"
        shutil.copyfile(there, self.out / f"{path}.txt")
        return f"{path}.txt"

    def listed(self, there):
        if there.is_dir():
            return there.name + "/"
        if there.suffix in (".cpp", ".hpp", ".py", ".yaml", ".xml", ".urdf", ".json", ".txt", ".md"):
            return f'<a href="{pathlib.PurePosixPath(self.copied(there)).name}">{there.name}</a>'
        return there.name

    def index(self):
        """README, with the list of all pages."""
        self.names.update(("commands/index", "messages", "api/index"))
        out = [self.page("README")]
        for captions, names in PARTS:
            listed = [page for name in names for page in pages([name]) or [name] if page in self.names]
            out.append("\n".join(["```{toctree}", ":hidden:", f":caption: {captions[self.language]}", "", *listed, "```", ""]))
        return "\n".join(out)


def ask(program, language, *arguments):
    environment = {name: value for name, value in os.environ.items() if name not in ("LC_ALL", "LC_MESSAGES", "LANGUAGE", "DISPLAY")}
    return subprocess.run([program, *arguments], env=environment | {"LANG": LANGUAGES[language]}, text=True, capture_output=True, check=True).stdout


def words_of_section(text, heading):
    """The first words of the lines of a section: its commands."""
    section = re.search(rf"^(?:{heading})\n((?:  .*\n)+)", text, re.M)
    return re.findall(r"^  (\w+)\s", section.group(1), re.M) if section else []


def command_pages(stage, program):
    """What each command says about itself, a page a command; returns all of it."""
    words, language = WORDS[stage.language], stage.language
    said = [ask(program, language, "--help")]
    commands = words_of_section(said[0], "Commands:|命令：")
    assert len(commands) > 15, commands
    for command in commands:
        text = ask(program, language, command, "--help")
        said.append(text)
        out = [f"# mjarm {command}\n", f"```text\n{text.rstrip()}\n```\n"]
        more = words_of_section(text, "Commands:|命令：")
        if command == "demo":
            more = [line.split()[0] for line in ask(program, language, "demo").splitlines() if line[:1].isalpha()]
        for one in more:
            said.append(ask(program, language, command, one, "--help"))
            out += [f"## mjarm {command} {one}\n", f"```text\n{said[-1].rstrip()}\n```\n"]
        stage.write(f"commands/{command}", "\n".join(out))
    stage.write("commands/index", "\n".join([f"# {words['commands']}\n", words["commands_text"] + "\n", f"```text\n{said[0].rstrip()}\n```\n",
                                             "```{toctree}\n:maxdepth: 1\n", *commands, "```\n"]))
    return "\n".join(said)


def message_files():
    return [*(ROOT / "mjarm/core/messages").glob("*.inc"), *(ROOT / "apps/mjarm/messages").glob("*.inc")]


def messages():
    """(topic, [(English, Chinese)]) of the catalogue of messages."""
    string = r'((?:"(?:\\.|[^"\\])*"\s*)+)'
    for file in sorted(message_files(), key=lambda file: file.stem):
        text = re.sub(r"^\s*//.*$", "", file.read_text(encoding="utf-8"), flags=re.M)
        found = re.findall(rf"MJARM_MSG\(\s*\w+\s*,\s*{string},\s*{string}\)", text)
        yield file.stem, [tuple(joined(one) for one in pair) for pair in found]


def joined(literals):
    text = "".join(re.findall(r'"((?:\\.|[^"\\])*)"', literals))
    return re.sub(r"\\(.)", lambda one: {"n": "\n", "t": " "}.get(one.group(1), one.group(1)), text)


def message_page(stage, helps):
    """All messages but those that explain commands, which the pages of commands show."""
    words = WORDS[stage.language]
    out = [f"# {words['messages']}\n", words["messages_text"] + "\n"]
    for topic, pairs in messages():
        lines = [line.replace("{{", "{").replace("}}", "}").rstrip() for pair in pairs for line in pair[stage.language != "en"].split("\n")]
        lines = [line for line in lines if line not in helps and len(line) > (15 if stage.language == "en" else 6)]  # nor words of labels
        if lines:
            out += [f"## {topic}\n", "```text", *lines, "```\n"]
    stage.write("messages", "\n".join(out).replace("\n\n\n", "\n\n"))


class Links(html.parser.HTMLParser):
    """What a page of HTML links to, loads, and may be linked to at."""

    def __init__(self, text):
        super().__init__()
        self.targets, self.loaded, self.ids = [], [], set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.ids.update(value for name, value in attributes if name in ("id", "name") and value)
        if tag == "a" and values.get("href"):
            self.targets.append(values["href"])
        for name in ("src", "data"):
            if values.get(name):
                self.loaded.append(values[name])
        if tag == "link" and values.get("href"):
            self.loaded.append(values["href"])


def link_faults(out):
    """Links within the site that lead nowhere, and what would be loaded from elsewhere."""
    pages_read = {file: Links(file.read_text(encoding="utf-8")) for file in sorted(out.rglob("*.html"))}
    for file, page in pages_read.items():
        name = file.relative_to(out).as_posix()
        yield from (f"{name}: loads {one}" for one in page.loaded if re.match(r"[a-z]+:|//", one) and not one.startswith("data:"))
        for target in [*page.targets, *(one for one in page.loaded if not re.match(r"[a-z]+:|//", one))]:
            if re.match(r"[a-z]+:|//", target):
                continue
            path, _, anchor = urllib.parse.unquote(target).partition("#")
            there = (file.parent / path.partition("?")[0]).resolve() if path else file
            if not there.is_file():
                yield f"{name}: {target}: no such file"
            elif anchor and there in pages_read and anchor not in pages_read[there].ids:
                yield f"{name}: {target}: no such anchor"
    for style in out.rglob("*.css"):
        if re.search(r"url\(\s*['\"]?(?:https?:)?//|@import", style.read_text(encoding="utf-8")):
            yield f"{style.relative_to(out).as_posix()}: loads from elsewhere"


def build(language, program, work, out):
    stage = Stage(language, work / language, out)
    stage.write("index", stage.index())
    for name in pages():
        stage.write(name, stage.page(name))
    message_page(stage, command_pages(stage, program))
    cpp_api.write_pages(ROOT, stage.work / "api", list(check_layers.ALLOWED), language)
    environment = os.environ | {"MJARM_SITE_LANGUAGE": language, "PYTHONDONTWRITEBYTECODE": "1", "LC_ALL": "C.UTF-8"}
    code = subprocess.run([sys.executable, "-m", "sphinx", "-b", "html", "-W", "--keep-going", "-q", "-c", str(HERE), "-d", str(work / f"{language}.trees"),
                           str(stage.work), str(out / language)], env=environment).returncode
    if code:
        sys.exit(f"site: Sphinx found faults in the pages in {language}")


def in_chinese(folder):
    """The few words of the theme that have no translation."""
    for file in [*folder.rglob("*.html"), folder / "_static/searchtools.js"]:
        text = file.read_text(encoding="utf-8")
        for english, chinese in THEME_IN_CHINESE.items():
            text = re.sub(english, chinese, text)
        file.write_text(text, encoding="utf-8")


def take_in_styles(static):
    """Debian's theme imports a style from where a web server of Debian has it: it goes into the site."""
    def style(found):
        file = pathlib.Path("/usr/share") / found.group(1)
        return file.read_text(encoding="utf-8") if file.exists() else ""

    for file in static.rglob("*.css"):
        file.write_text(re.sub(r"@import url\(/([\w./-]+)\);", style, file.read_text(encoding="utf-8")), encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", required=True)
    parser.add_argument("--out", required=True, type=pathlib.Path)
    options = parser.parse_args()
    out = options.out.resolve()
    work = out.with_name(out.name + ".pages")
    for folder in (out, work):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
    for language in LANGUAGES:
        build(language, options.program, work, out)
        take_in_styles(out / language / "_static")
    in_chinese(out / "zh-CN")
    shutil.copyfile(HERE / "start.html", out / "index.html")
    shutil.rmtree(work)
    faults = list(link_faults(out))
    print("\n".join(faults[:50]) if faults else f"site: {sum(1 for _ in out.rglob('*.html'))} pages in {out / 'index.html'}")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
