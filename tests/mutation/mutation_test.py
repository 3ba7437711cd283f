"""Gives the program changed files of every kind, and looks at what it does and answers.

  python3 tests/mutation/mutation_test.py [--program build/dev/bin/mjarm] [--seconds 10] [--seed 1] [--parser ik,sb3] [--keep FOLDER]

The same seed gives the same inputs, in the same order for each parser; time says how many. What is found is kept as a file in
FOLDER, beside a text that says what is wrong and how to see it again; the exit code is 1 then.
"""
import argparse
import itertools
import os
import pathlib
import random
import shlex
import sys
import tempfile
import threading
import time

import parsers
from run import Bounds, faults_of, run


class Trial:
    """All inputs of one call, drawn in turn by several threads."""

    def __init__(self, options):
        self.options = options
        chosen = options.parser.split(",") if options.parser else None
        self.parsers = [parser for parser in parsers.all_parsers() if chosen is None or parser.name in chosen]
        if not self.parsers or (chosen and len(self.parsers) != len(chosen)):
            sys.exit("--parser: one or more of " + ", ".join(parser.name for parser in parsers.all_parsers()))
        self.cases = ((parser, i) for i in itertools.count() for parser in self.parsers)
        self.lock = threading.Lock()
        self.count, self.codes, self.found = 0, {}, []

    def run_all(self):
        end = time.monotonic() + self.options.seconds
        while time.monotonic() < end:
            with self.lock:
                parser, i = next(self.cases)
            data = parser.input(random.Random(f"{self.options.seed}/{parser.name}/{i}"))
            faults, code = self.run_one(parser, data)
            with self.lock:
                self.count += 1
                self.codes[code] = self.codes.get(code, 0) + 1
                if faults:
                    self.keep(f"{parser.name}-{self.options.seed}-{i}", parser, data, faults)

    def run_one(self, parser, data):
        with tempfile.TemporaryDirectory(prefix="mjarm_mutation_") as name:
            folder = pathlib.Path(name)
            arguments = parsers.lay_down(parser, data, folder)
            result = run(self.options.program, ["--quiet", *arguments], folder, Bounds(self.options.memory, self.options.cpu_seconds))
            faults = list(faults_of(result, [parser.file, *parser.made]))
            if not faults:
                try:
                    faults += parser.check(data, result)
                except Exception as error:  # the answer is not even of the right shape, or the input never was
                    faults.append(f"cannot be judged: {type(error).__name__} {error}")
            return faults, result.code

    def keep(self, name, parser, data, faults):
        folder = pathlib.Path(self.options.keep)
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
        command = shlex.join(["mjarm", "--quiet", *parser.arguments])
        (folder / (name + ".txt")).write_text("\n".join(faults) + f"\n{command}   # with this file as {parser.file}\n")
        self.found.append(name)
        print(f"FINDING {folder / name}: {faults[0]}", flush=True)


def main():
    reader = argparse.ArgumentParser()
    reader.add_argument("--program", default="build/dev/bin/mjarm", type=os.path.abspath)
    reader.add_argument("--seconds", type=float, default=10)
    reader.add_argument("--seed", default="1")
    reader.add_argument("--parser", default="", help="names of parsers, with commas; default: all, in turn")
    reader.add_argument("--write-seeds", metavar="FOLDER", help="only write what is changed, for other fuzzers")
    reader.add_argument("--list", action="store_true", help="only the names of the parsers")
    reader.add_argument("--memory", type=float, default=2, help="[GiB] most of a run; 0: no bound")
    reader.add_argument("--cpu-seconds", type=int, default=30, help="most of a run")
    reader.add_argument("--keep", default="mutation-found")
    reader.add_argument("--jobs", type=int, default=os.cpu_count())
    options = reader.parse_args()
    trial = Trial(options)
    if options.write_seeds:
        for parser in trial.parsers:
            for i, seed in enumerate(parser.seeds):
                pathlib.Path(options.write_seeds, f"{parser.name}-{i}").write_bytes(seed)
        return
    if options.list:
        print("\n".join(parser.name for parser in trial.parsers))
        return
    threads = [threading.Thread(target=trial.run_all) for _ in range(options.jobs)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    codes = ", ".join(f"{n} with exit code {code}" for code, n in sorted(trial.codes.items()))
    print(f"seed {options.seed}: {trial.count} inputs of {len(trial.parsers)} parsers ({codes}); findings: {len(trial.found)}")
    sys.exit(1 if trial.found else 0)


if __name__ == "__main__":
    main()
