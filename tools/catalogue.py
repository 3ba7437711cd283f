"""Texts of references in Chinese, beside the English ones that they stand for."""


class Catalogue:
    """`## NAME`, then each piece of what is said there on one line, with its Chinese on indented ones below; under `## *` it holds everywhere."""

    def __init__(self, text, file):
        self.file, self.lines, self.chinese, self.faults = file, {}, {}, []
        name = key = None
        for number, line in enumerate(text.splitlines(), 1):
            if line.startswith("## "):
                name = line[3:]
            elif name and line.startswith("  "):
                self.chinese[key] = self.chinese.get(key, "") + line.strip()
            elif name and line:
                key = name, line
                if key in self.lines:
                    self.faults.append(f"{file}:{number}: {name}: stands twice: {line}")
                self.lines[key] = number
        self.unused = dict(self.lines)

    def piece(self, name, english):
        key = (name, english) if (name, english) in self.lines else ("*", english)
        self.unused.pop(key, None)
        if key not in self.chinese:
            self.faults.append(f"{self.file}: {name}: has no Chinese: {english}")
        return self.chinese.get(key, english)

    def all_faults(self):
        """A line each: what has no Chinese, and Chinese that nothing asked for."""
        unused = (f"{self.file}:{number}: {name}: nothing says this: {english}" for (name, english), number in self.unused.items())
        return [*dict.fromkeys(self.faults), *unused]
