#!/usr/bin/env python3
"""What `pellucid-cli optimize` reaches on many volumes, and what the pictures look like.

    optimize_grid.py PELLUCID_CLI VOLUME... [--tf auto,tents:3] [--targets equal,diagonal,1:3:6]
                     [--views 30,20 120,30] [--against no-coarse "method parallel" ...] [--sheet FOLDER]

Targets of numbers, as 1:3:6, are repeated or cut to as many as there are features. --against runs where F with
--exact-shares is above 0.001: below, nothing can be nearer by more than that.

One line per problem: how it ended, F before and after, coverage, the least cover of a wanted feature, evaluations and
seconds. A problem is marked where its answer is farther from the targets than its start or, with --exact-shares, than
what one of --against reaches by more than 0.001; where the coverage leaves [0.2, 0.75]; and where a wanted feature has a
cover below 0.02 that the program does not tell. Exit status 1 where any is marked. --sheet draws each before and after.
"""
import argparse
import json
import os
import subprocess
import sys

MARGIN, LEAST_COVERAGE, MOST_COVERAGE, LEAST_COVER = 1e-3, 0.199, 0.75, 0.0199


def run(cli, arguments, timeout=900):
    done = subprocess.run([cli, *arguments], capture_output=True, text=True, timeout=timeout)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip())
    return done.stdout


def optimize(cli, problem, options):
    return json.loads(run(cli, ["optimize", *problem, *options, "--json"]))


def features(cli, volume, tf):
    return len(json.loads(run(cli, ["measure", volume, "--tf", tf, "--json"]))["features"])


def in_words(target, count):
    if ":" not in target:
        return target
    numbers = target.split(":")
    return ",".join(numbers[i % len(numbers)] for i in range(count))


def reached(answer):
    return answer["objective"][answer["best"]]


def judge(answer, exact, others):
    marks = []
    covers = [c for c, t in zip(answer["covers"], answer["target"]) if t > 0]
    told = "faint" in answer
    if not LEAST_COVERAGE <= answer["coverage"] <= MOST_COVERAGE and not told:
        marks.append(f"coverage {answer['coverage']:.3f}")
    if min(covers) < LEAST_COVER and not told:
        marks.append(f"cover {min(covers):.3f}")
    if reached(exact) > exact["objective"][0]:
        marks.append("farther than its start")
    for options, other in others.items():
        if reached(exact) > reached(other) + MARGIN:
            marks.append(f"{options} reaches {reached(other):.4f}")
    return marks


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cli")
    parser.add_argument("volumes", nargs="+")
    parser.add_argument("--tf", default="auto,tents:3")
    parser.add_argument("--targets", default="equal,diagonal,inside-out")
    parser.add_argument("--views", nargs="+", default=["30,20"])
    parser.add_argument("--against", nargs="*", default=[])
    parser.add_argument("--sheet")
    given = parser.parse_args()
    marked = problems = 0
    for volume in given.volumes:
        for tf in given.tf.split(","):
            try:
                count = features(given.cli, volume, tf)
            except (RuntimeError, subprocess.TimeoutExpired) as error:
                print(f"{os.path.basename(volume)} {tf}: {error}", flush=True)
                continue
            for view in given.views:
                for target in given.targets.split(","):
                    name = f"{os.path.basename(volume)} {tf} {view} {target}"
                    problem = [volume, "--tf", tf, "--view", view, "--target", in_words(target, count)]
                    try:
                        answer = optimize(given.cli, problem, [])
                        exact = optimize(given.cli, problem, ["--exact-shares"]) if "exact" in answer else answer
                        others = {o: optimize(given.cli, problem, ["--exact-shares", *f"--{o}".split()])
                                  for o in given.against if reached(exact) > MARGIN}
                    except (RuntimeError, subprocess.TimeoutExpired) as error:
                        print(f"{name}: {error}", flush=True)
                        continue
                    problems += 1
                    marks = judge(answer, exact, others)
                    marked += bool(marks)
                    covers = [c for c, t in zip(answer["covers"], answer["target"]) if t > 0]
                    line = (f"{name}: {answer['stopped']}, F {answer['objective'][0]:.4f} -> {reached(answer):.5f}, "
                            f"coverage {answer['coverage']:.3f}, least cover {min(covers):.3f}, "
                            f"{answer['evaluations']} evaluations, {answer['seconds']['search']:.2f} s")
                    if "exact" in answer:
                        line += f"; exact F {answer['exact']['objective']:.5f}, coverage {answer['exact']['coverage']:.3f}"
                    for options, other in others.items():
                        line += f"; {options} {reached(other):.5f}"
                    print(line + ("  MARKED: " + ", ".join(marks) if marks else ""), flush=True)
                    if given.sheet:
                        os.makedirs(given.sheet, exist_ok=True)
                        file = os.path.join(given.sheet, name.replace(" ", "_").replace(":", "").replace(",", "_"))
                        after = file + ".tf.json"
                        with open(after, "w", encoding="utf-8") as out:
                            json.dump(answer["tf"], out)
                        for state, curve in (("before", tf), ("after", after)):
                            run(given.cli, ["render", volume, "--tf", curve, "--view", view, "--size", "256x256", "--out",
                                            f"{file}_{state}.png"])
                        os.remove(after)
    print(f"{problems} problems, {marked} marked")
    return 1 if marked else 0


if __name__ == "__main__":
    sys.exit(main())
