"""Has `open_files` and `open_foreign` open one file after the other, for the programs beside this one that damage files."""

import json
import os
import select
import subprocess
import tempfile
import time
import unicodedata


# Marks of direction, embeddings, overrides and isolates.
TURNS = "\u061c\u200e\u200f\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"


def is_opener(program):
    return os.path.basename(program) in ("open_files", "open_foreign")


class Answer:
    """What became of one file: `status` as that of pellucid-cli, `read` what open_files says of it, `said` the words of
    an error or, where the process has ended, what it left on stderr; `cpu` in seconds, `mib` of the heap, -1 where that
    is not known."""

    def __init__(self, status, read=None, said="", cpu=0.0, mib=-1.0):
        self.status, self.read, self.said, self.cpu, self.mib = status, read, said, cpu, mib


class Opener:
    """One of these programs, begun again where a file has ended it: that file is the one that was being read."""

    def __init__(self, words, wall_seconds):
        self.words, self.wall = words, wall_seconds
        self.process, self.errors = None, None

    def open(self, path):
        if self.process is None:
            self._start()
        try:
            self.process.stdin.write(os.fsencode(path) + b"\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            return self._ended()
        begin = time.monotonic()
        while not select.select([self.process.stdout], [], [], 1.0)[0]:
            if time.monotonic() - begin > self.wall:
                self.process.kill()
                answer = self._ended()
                answer.said = "still runs after %d s; %s" % (self.wall, answer.said)
                return answer
        line = self.process.stdout.readline()
        if not line.endswith(b"\n"):
            return self._ended()
        try:
            told = json.loads(line)
        except ValueError:
            return Answer(-1, said="no JSON: " + repr(line[:300]))
        return Answer(0 if told["read"] else 1, told, told.get("error", ""), told["cpu"], told["heap_mib"])

    def close(self):
        if self.process is not None:
            self.process.stdin.close()
            self.process.wait()

    def _start(self):
        self.errors = tempfile.TemporaryFile()
        # A finding of a sanitizer ends a reader of foreign formats with a status of its own: its stderr is not kept, and
        # it may not start what searches for leaks. Allocations that fail are for the program to tell of; those that the
        # limit on memory would refuse to a reader of small files fail here, too.
        environment = dict(os.environ, UBSAN_OPTIONS="print_stacktrace=1",
                           ASAN_OPTIONS="detect_leaks=0:exitcode=99:allocator_may_return_null=1:quarantine_size_mb=32:"
                                        "max_allocation_size_mb=257")
        self.process = subprocess.Popen(self.words, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=self.errors, env=environment)

    def _ended(self):
        status = self.process.wait()
        self.process = None
        self.errors.seek(0)
        said = self.errors.read().decode("utf-8", "replace")
        return Answer(status if status < 0 else -1000 - status, said=said[-3000:])


def line_fault(said):
    """What is wrong with the words of an error, which stand on one line, with nothing that steers a terminal or turns the
    direction of writing; empty where nothing is."""
    steers = any(unicodedata.category(c) in ("Cc", "Cs", "Zl", "Zp") or c in TURNS for c in said)
    return "not one printable line: " + repr(said[:300]) if steers or len(said) < 10 else ""
