"""What the scripts of the peers share: each peer in a process of its own, clocks, and answers.

A script SUITE.py JOB.json ANSWERS.jsonl (mjarm calls it) has a table of peers, name -> (maker, package),
and a function run(job, name, maker, row) -> answers; see `start`.
"""

import importlib.metadata
import json
import os
import subprocess
import sys
import time
import warnings

SECONDS = 20  # a set gets no more than that: slow peers do fewer rounds, or only its first cases
LIMIT = 300  # [s] for one peer, where the job names no other


def best_times(arguments, rounds, call, pick):
    """Best time of each call [us], and what `pick` made of its answer in the first round."""
    for words in arguments[:5]:
        call(*words)  # caches and lazy imports
    best, answers = [], []
    end = time.monotonic() + SECONDS
    for words in arguments:
        if time.monotonic() > end:
            break
        start = time.perf_counter_ns()
        answer = call(*words)
        best.append((time.perf_counter_ns() - start) / 1000)
        answers.append(pick(answer))
    for _ in range(1, rounds):
        if time.monotonic() > end:
            break
        for i, words in enumerate(arguments[: len(best)]):
            start = time.perf_counter_ns()
            call(*words)
            best[i] = min(best[i], (time.perf_counter_ns() - start) / 1000)
    return best, answers


def best_mean(rounds, count, work, begin=lambda: None):
    """Best mean time of `count` calls that `work` makes [us]: one alone is too short for the clock, or all are one."""
    best = float("inf")
    for _ in range(rounds):
        begin()
        start = time.perf_counter_ns()
        work()
        best = min(best, (time.perf_counter_ns() - start) / 1000 / count)
    return [best]


def version_of(package):
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "?"


def child(peers, run, job_file, name):
    """The answers of one peer, one a line on standard output."""
    warnings.simplefilter("ignore")
    out = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what libraries print is no answer
    with open(job_file, encoding="utf-8") as file:
        job = json.load(file)
    maker, package = peers[name]
    version = version_of(package)
    try:
        if version == "?":
            raise NotImplementedError("not installed")
        rows = list(run(job, name, maker, {"who": name, "version": version, "timed": "python"}))
    except Exception as error:  # whatever a peer cannot do is its result
        said = getattr(error, "stderr", None)  # the last line of a tool that failed says why
        lines = said.decode(errors="replace").splitlines()[-1:] if said else str(error).splitlines()
        rows = [{"who": name, "version": version, "error": (lines or [type(error).__name__])[0][:80]}]
    for row in rows:
        print(json.dumps(row), file=out)
    out.close()


def parent(peers, job_file, answer_file):
    environment = os.environ | {name: "1" for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")}
    with open(job_file, encoding="utf-8") as file:
        job = json.load(file)
    limit = job.get("seconds", LIMIT)
    with open(answer_file, "w", encoding="utf-8") as file:
        for name in job.get("peers") or peers:
            command = [sys.executable, os.path.abspath(sys.argv[0]), "--peer", name, job_file]
            try:
                done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=limit)
                rows = done.stdout
                if done.returncode != 0:
                    rows = json.dumps({"who": name, "version": "?", "error": f"ended with {done.returncode}"}) + "\n"
            except subprocess.TimeoutExpired:
                rows = json.dumps({"who": name, "version": "?", "error": f"more than {limit:.0f} s"}) + "\n"
            file.write(rows)


def start(peers, run):
    """Runs the script: all peers, those that the job names, or the one that its own arguments name.

    peers: name -> (maker, package); run(job, name, maker, row) gives the answers of one peer, `row` being
    what all of them have in common.
    """
    if sys.argv[1] == "--peer":
        child(peers, run, sys.argv[3], sys.argv[2])
    else:
        parent(peers, sys.argv[1], sys.argv[2])
