#!/usr/bin/env python3
"""What `measure` takes on ranks, against one process: the tables of processor time in docs/scale.md.

    ranks.py --bin build/headless/bin big.mhd --tf tents:4:0.3 [--ranks 2,4,8] [--threads 1] [--rounds 3] [--touch 8]
             [-- options of measure, such as --raw 1024,1024,1024,u8]

One process (`pellucid-cli`, with --threads threads) and the ranks (`pellucid-mpi`, one thread each) take turns; a round is
one pair for each number of ranks, and one run each on 1 and 2 ranks. Prints each run, and as medians (with the least and
the most of a round):

    time     processor time, user and system, of the ranks and of mpirun / that of the process next to it
    faster   how much sooner two ranks are done than one

With --touch, that many GiB are touched and released before each run, so that all runs find the memory that they need. A
virtual machine gives memory that is free back to its host, and is charged for having it again; what a run is charged then
depends on what the one before it has released.
"""
import argparse
import mmap
import multiprocessing
import os
import shlex
import statistics
import subprocess
import sys
import time
from pathlib import Path

PART = 1 << 24


def touch(gib):
    """Fills memory, in a process of its own that ends with it."""
    def fill():
        memory, part = mmap.mmap(-1, gib << 30), b"\1" * PART
        for _ in range((gib << 30) // PART):
            memory.write(part)
    filling = multiprocessing.get_context("fork").Process(target=fill)
    filling.start()
    filling.join()
    if filling.exitcode != 0:
        sys.exit(f"cannot touch {gib} GiB, give --touch less")


class Run:
    """A command: its processor time and how long it took, in seconds."""

    def __init__(self, command):
        begin = time.monotonic()
        try:
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        except OSError as problem:
            sys.exit(f"{problem}, see --bin and --mpirun")
        said = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)  # with what the processes that it started have used
        process.returncode = os.waitstatus_to_exitcode(status)
        self.took = time.monotonic() - begin
        if process.returncode != 0:
            sys.exit(f"{shlex.join(map(str, command))} ended with {process.returncode}\n{said.strip()}")
        self.user, self.system = usage.ru_utime, usage.ru_stime

    @property
    def time(self):
        return self.user + self.system

    def __str__(self):
        return f"user {self.user:.2f} s, system {self.system:.2f} s, took {self.took:.2f} s"


def spread(values):
    least, most = min(values), max(values)
    return f"{statistics.median(values):.2f}" + (f" ({least:.2f}–{most:.2f})" if len(values) > 1 else "")


def positive(text):
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError("expected 1 or more")
    return number


def main():
    own, others = sys.argv[1:], []
    if "--" in own:
        own, others = own[:own.index("--")], own[own.index("--") + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("volume", help="a file that is not compressed")
    parser.add_argument("--bin", type=Path, required=True, help="folder of pellucid-cli and pellucid-mpi")
    parser.add_argument("--tf", required=True, help="file, or a name as the programs take it")
    parser.add_argument("--view", default="30,20")
    parser.add_argument("--ranks", default="2,4,8", type=lambda text: [positive(n) for n in text.split(",")])
    parser.add_argument("--threads", default=1, type=positive, help="of the one process (default 1)")
    parser.add_argument("--rounds", default=3, type=positive)
    parser.add_argument("--touch", type=positive, metavar="GIB", help="memory to touch before each run")
    parser.add_argument("--mpirun", default="mpirun --oversubscribe --bind-to none", help="how ranks are started")
    options = parser.parse_args(own)

    measure = ["measure", options.volume, "--tf", options.tf, "--view", options.view, *others]

    def run(name, command):
        if options.touch:
            touch(options.touch)
        result = Run(command)
        print(f"{name}: {result}", flush=True)
        return result

    def alone():
        return run("one process", [options.bin / "pellucid-cli", *measure, "--threads", str(options.threads)])

    def on_ranks(count):
        return run(f"{count} rank{'s' if count > 1 else ''}", [*shlex.split(options.mpirun), "-n", str(count),
                                                               options.bin / "pellucid-mpi", *measure, "--threads", "1"])

    ratios, faster = {count: [] for count in options.ranks}, []
    alone()  # reads the file into the system's cache, and does not count
    for number in range(options.rounds):
        print(f"round {number + 1} of {options.rounds}")
        for count in options.ranks:
            process = alone()
            ratios[count].append(on_ranks(count).time / process.time)
        one = on_ranks(1)
        faster.append(one.took / on_ranks(2).took)
    for count in options.ranks:
        print(f"time, {count} ranks / one process with {options.threads} thread"
              f"{'s' if options.threads > 1 else ''}: {spread(ratios[count])}")
    print(f"faster, 2 ranks against 1: {spread(faster)}")


if __name__ == "__main__":
    main()
