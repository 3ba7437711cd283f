"""Runs the libraries that give all branches of inverse kinematics on the poses of `mjarm bench ik --all`.

Usage: ik_all.py JOB.json ANSWERS.jsonl (mjarm calls it). As ik.py: the clock stands right around the
library's own call, and mjarm judges the answers.
"""

import driver
import ik


def eaik(job):
    prepare, call, _ = ik.eaik(job)

    def pick(answer):
        exact = (q for q, least_squares in zip(answer.Q, answer.is_LS) if not least_squares)
        return [list(map(float, q)) for q in exact if ik.within(q, job)]

    return prepare, call, pick


def ssik(job):
    solve = ik.ssik_module(job).solve

    def call(target):
        return solve(target, enumerate_windings=False)

    def pick(found):
        return [list(map(float, one.q)) for one in found if ik.within(one.q, job)]

    return lambda case: (ik.matrix(case),), call, pick


PEERS = {"EAIK": (eaik, "eaik"), "ssik": (ssik, "ssik")}


def run_peer(job, name, maker, row):
    prepare, call, pick = maker(job)
    us, answers = driver.best_times([prepare(case) for case in job["cases"]], job["rounds"], call, pick)
    return [row | {"set": "branches", "us": us, "q": answers}]


if __name__ == "__main__":
    driver.start(PEERS, run_peer)
