#!/usr/bin/env python3
"""Runs every command of pellucid-cli that writes files where these cannot be written, and looks at what is left.

A disk that is full, at once or half way; a folder that is read-only, belongs to somebody else, or goes away meanwhile; a
limit on the size of files, on address space and on processes; names as long as they may be, and longer. Each time there
has to be exit status 1, one line on stderr, no unfinished file, and what was there before as it was; where a limit leaves
enough, the file. Exit status: 0 all well, 1 something was found, 2
wrong usage.

    writing_faults.py build/release/bin/pellucid-cli

Disks are small ones in memory, which are mounted in a namespace of their own; where that is not allowed these faults are
left out, and that is said. Needs Python 3.8, unshare and setpriv (util-linux).
"""

import argparse
import functools
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SHELLS = ["sample:shells", "--sample-size", "40"]
TOLD = ["sample:shells", "--sample-size", "16", "--tf", "tents:3"]
VIEWED = TOLD + ["--engine", "cpu"]
AIMED = VIEWED + ["--target", "1,1,1", "--max-iterations", "1"]
PICTURE = ["--size", "64x64"]
SERIES = ["sample:smoke", "--sample-size", "16", "--frames", "0:1"]
FILM = ["film", *TOLD, "--size", "192x160", "--seconds", "0.4", "--out", "{}"]  # more than a page for each picture

# What commands read, made before them.
INPUTS = {"{volume}": ["generate", "shells", "--size", "16", "--out", "volume.nrrd"],
          "{picture}": ["render", *VIEWED, *PICTURE, "--out", "picture.png"],
          "{other}": ["render", *VIEWED, *PICTURE, "--view", "10,10", "--out", "other.png"]}

# What is run, with {} for the output; a name without a suffix is a folder.
COMMANDS = [
    (["convert", *SHELLS, "--type", kind, "--out", "{}"], "a" + suffix)
    for kind, suffix in (("u16", ".nrrd"), ("i16", ".mha"), ("f32", ".mhd"), ("u8", ".nii"), ("f64", ".nii.gz"),
                         ("f32", ".vti"), ("u16", ".tif"), ("u8", ".tiff"), ("f32", ".zarr"))
] + [
    (["convert", *SERIES, "--all-frames", "--out", "{}"], "a.pvd"),
    (["convert", "tents:3", "--volume", "{volume}", "--to", "inviwo", "--out", "{}"], "a.itf"),
    (["convert", "tents:3", "--to", "slicer", "--out", "{}"], "a.mrml"),
    (["generate", "shells", "--size", "24", "--out", "{}"], "a.nrrd"),
    *((["render", *VIEWED, *PICTURE, "--out", "{}"], "a" + suffix) for suffix in (".png", ".jpg", ".tif", ".exr")),
    (["render", *VIEWED, *PICTURE, "--layers", "{}"], "layers"),
    (["plot", *TOLD, "--out", "{}"], "a.svg"),
    (["figure", *VIEWED, "--out", "{}"], "a.svg"),
    (["figure", *VIEWED, "--out", "{}"], "a.pdf"),
    (["share", *TOLD, "--out", "{}"], "a.html"),
    (["thumbnail", "{volume}", "{}"], "a.png"),
    (["saliency-map", "{picture}", "--out", "{}"], "a.exr"),
    (["compare", "{picture}", "{other}", "--side-by-side", "{}"], "a.png"),
    (["rulers", "{volume}", "--sphere", "8,8,8,3", "--csv", "{}"], "a.csv"),
    (["measure", *VIEWED, "--bars", "{}"], "a.svg"),
    (["fields", *VIEWED, "--out", "{}"], "fields"),
    (FILM, "film"),
    (FILM, "a.apng"),
    (["sequence", *SERIES, "--tf", "tents:3", "--engine", "cpu", *PICTURE, "--out", "{}"], "sequence"),
    (["optimize", *AIMED, "--out-tf", "{}"], "a.tf.json"),
    (["optimize", *AIMED, "--out-camera", "{}"], "a.camera.json"),
    (["optimize", *AIMED, "--curves", "{}"], "a.csv"),
    (["optimize", *AIMED, "--report-size", "64x64", "--report", "{}"], "report"),
    (["propose", *TOLD[:3], "--out-tf", "{}"], "a.tf.json"),
    (["views", *VIEWED, "--feature", "f1", "--count", "16", "--map", "{}"], "a.csv"),
    (["space", *VIEWED, "--target", "1,1,1", "--samples", "3", "--save", "{}"], "a.nrrd"),
    (["space", *VIEWED, "--target", "1,1,1", "--samples", "3", "--csv", "{}"], "a.csv"),
    (["space", *VIEWED, "--target", "1,1,1", "--samples", "3", *PICTURE, "--out", "{}"], "a.png"),
    (["colors", *TOLD, "--out-tf", "{}"], "a.tf.json"),
    (["completions", "bash", "--out", "{}"], "a.sh"),
    (["reproduce", "4.2", "--sample-size", "16", "--out", "{}"], "reproduced"),
]
if shutil.which("ffmpeg"):
    COMMANDS += [(FILM, "a.mp4"), (FILM, "a.gif")]

OLD = b"what was there before\n"


def tree(folder):
    """Everything in a folder, by name: bytes of files, None of folders."""
    found = {}
    for where, folders, names in os.walk(folder):
        for name in folders:
            found[os.path.relpath(os.path.join(where, name), folder)] = None
        for name in names:
            with open(os.path.join(where, name), "rb") as file:
                found[os.path.relpath(os.path.join(where, name), folder)] = file.read()
    return found


class Case:
    """A command and its output, and what that is where all is well. `inputs`: paths of INPUTS."""

    def __init__(self, program, words, name, inputs):
        self.words, self.name, self.program = [inputs.get(word, word) for word in words], name, program
        self.is_folder = "." not in name
        with tempfile.TemporaryDirectory() as folder:
            run = self.run(folder)
            if run.returncode != 0:
                raise SystemExit("%s: %s" % (" ".join(words), run.stderr.decode()))
            self.good = tree(folder)

    def command(self, folder, name=None):
        path = os.path.join(folder, name or self.name)
        return [self.program, *(path if word == "{}" else word for word in self.words)]

    def run(self, folder, name=None, before=(), prepare=None):
        return subprocess.run([*before, *self.command(folder, name)], stdin=subprocess.DEVNULL, capture_output=True,
                              timeout=120, preexec_fn=prepare)

    def bytes(self):
        """Of the largest file."""
        return max(len(data) for data in self.good.values() if data is not None)

    def all_bytes(self):
        return sum(len(data) for data in self.good.values() if data is not None)

    def put_old(self, folder):
        """Files of these names that are there already; none for a folder that has to be new."""
        if not self.name.endswith(".zarr"):
            for name, data in self.good.items():
                path = os.path.join(folder, name)
                if data is None:
                    os.makedirs(path)
                else:
                    with open(path, "wb") as file:
                        file.write(OLD)

    def fault_of(self, run, folder, statuses=(1,)):
        """What is wrong with a run that could not write."""
        said = run.stderr.decode("utf-8", "replace")
        if run.returncode not in statuses:
            # GLib ends the program where it gets no thread, before a figure is begun, see docs/reliability.md.
            if run.returncode == -signal.SIGTRAP and "creating thread '[pango]" in said and not tree(folder):
                return ""
            return "exit status %d: %s" % (run.returncode, said[-300:])
        said = re.sub("^(pellucid-cli: note: .*\n)*", "", said)  # as of what is in a page that is to be shared
        if said.count("\n") != 1 or not said.startswith("pellucid-cli: error: ") or not said[:-1].isprintable():
            return "not one line on stderr: " + repr(said[-500:])
        for name, data in tree(folder).items():
            # A film that was stopped keeps what it has drawn, to go on from there.
            if "film" in run.args and (name.endswith(".pictures") or "film.progress.json" in name
                                           or os.path.dirname(name).endswith(".pictures")):
                continue
            # The page of what was done says how far it has come.
            if "reproduce" in run.args and name.endswith("index.html"):
                continue
            # Of several files some may be whole.
            if name not in self.good or (data != OLD and data != self.good[name]):
                return "%s is left, %s" % (name, "a folder" if data is None else "%d bytes" % len(data))
        return ""


class Report:
    def __init__(self):
        self.counts, self.failed, self.left_out = {}, [], []

    def add(self, fault, case, wrong):
        self.counts[fault] = self.counts.get(fault, 0) + 1
        if wrong:
            self.failed.append("%s, %s: %s" % (fault, " ".join(case.command("")), wrong))


def mount(*words):
    subprocess.run(["mount", *words], check=True, stderr=subprocess.DEVNULL)


class Disk:
    """A disk of 16 MiB in memory."""

    def __init__(self, folder):
        self.folder = folder
        mount("-t", "tmpfs", "-o", "size=16m", "pellucid-disk", folder)

    def fill_up(self, left):
        """All but `left` bytes, in whole pages."""
        with open(os.path.join(self.folder, ".filler"), "wb", buffering=0) as filler:
            free = os.statvfs(self.folder)
            filler.truncate(0)
            pages = free.f_bfree - (left + free.f_bsize - 1) // free.f_bsize
            for _ in range(max(pages, 0)):
                filler.write(b"x" * free.f_bsize)

    def drop_filler(self):
        os.remove(os.path.join(self.folder, ".filler"))

    def close(self):
        subprocess.run(["umount", self.folder], check=True)


def on_full_disk(case, report, folder):
    for fault, part in (("full disk", 0), ("disk that fills up", 0.5)):
        left = int(case.all_bytes() * part)
        if part > 0 and left < 8192:
            continue  # it fits into a page
        disk = Disk(folder)
        case.put_old(folder)
        disk.fill_up(left)
        run = case.run(folder)
        disk.drop_filler()
        report.add(fault, case, case.fault_of(run, folder))
        disk.close()


def on_read_only_disk(case, report, folder):
    disk = Disk(folder)
    case.put_old(folder)
    mount("-o", "remount,ro", folder)
    report.add("read-only disk", case, case.fault_of(case.run(folder), folder))
    disk.close()


def in_foreign_folder(case, report, folder):
    """As somebody who may read and list it, but not write."""
    case.put_old(folder)
    os.chmod(folder, 0o555)
    for where, _, _ in os.walk(folder):
        os.chmod(where, 0o555)
    nobody = AS_NOBODY if os.geteuid() == 0 else []
    report.add("folder of others", case, case.fault_of(case.run(folder, before=nobody), folder))
    for where, _, _ in os.walk(folder):
        os.chmod(where, 0o755)


def with_limit(case, report, folder):
    for part in (0, 0.6):
        most = int(case.bytes() * part)
        case.put_old(folder)
        run = case.run(folder, prepare=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
        # The message goes through a pipe, which the limit does not hold for.
        report.add("limit on file sizes", case, case.fault_of(run, folder))
        shutil.rmtree(folder)
        os.mkdir(folder)


AS_NOBODY = ["setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"]


@functools.cache
def least_memory(program):
    """MiB of address space that the program needs to begin at all."""
    for mib in range(20, 4000, 10):
        if subprocess.run([program, "samples"], capture_output=True,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (mib << 20, mib << 20))).returncode == 0:
            return mib
    return 4000


def without_warnings(stderr):
    """What Mesa says of drivers that it cannot load is not ours."""
    lines = stderr.split(b"\n")
    return b"\n".join(line for n, line in enumerate(lines)
                      if not line.startswith(b"libEGL warning") and (line or n + 1 == len(lines)))


def written_or_told(case, run, folder):
    """What is wrong with a run that a limit may have stopped."""
    if run.returncode != 0:
        run.stderr = without_warnings(run.stderr)
        return case.fault_of(run, folder)
    return "" if sorted(tree(folder)) == sorted(case.good) else "no error, and not all that should be there"


def with_little_memory(case, report, folder):
    least = least_memory(case.program)
    for factor in (1, 1.2, 1.5, 2, 4):
        most = int(least * factor) << 20
        run = case.run(folder, prepare=lambda: resource.setrlimit(resource.RLIMIT_AS, (most, most)))
        report.add("limit on memory", case, written_or_told(case, run, folder))
        shutil.rmtree(folder)
        os.mkdir(folder)


def with_few_processes(case, report, folder):
    """For somebody who has none yet; nothing limits those of root."""
    for most in (1, 2):
        os.chmod(folder, 0o777)
        run = case.run(folder, before=["prlimit", "--nproc=%d" % most, *AS_NOBODY])
        report.add("limit on processes", case, written_or_told(case, run, folder))
        shutil.rmtree(folder)
        os.mkdir(folder)


def while_it_goes_away(case, report, folder):
    """Removed while the command works: it has written before that, or says what is wrong."""
    for wait in (0.01, 0.03, 0.1, 0.3):
        inner = os.path.join(folder, "inner")
        os.mkdir(inner)
        process = subprocess.Popen(case.command(inner), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        end = time.monotonic() + wait
        while time.monotonic() < end and process.poll() is None:
            if any(name.endswith(".part") for name in os.listdir(inner)):
                break  # it is at it
        shutil.rmtree(inner, ignore_errors=True)
        out, err = process.communicate(timeout=120)
        run = subprocess.CompletedProcess((), process.returncode, out, err)
        if run.returncode != 0:
            report.add("folder that goes away", case, case.fault_of(run, folder) if not os.path.exists(inner) else "")
        shutil.rmtree(folder)
        os.mkdir(folder)


def with_long_names(case, report, folder):
    suffix = "" if case.is_folder else case.name[1:]
    longest = "n" * (255 - len(suffix)) + suffix
    run = case.run(folder, name=longest)
    if max(len(name.split("/")[0]) for name in case.good) > len(case.name):
        wrong = case.fault_of(run, folder)  # files beside it, such as a_0.vti of a.pvd, have a name too long
    else:
        wrong = "" if run.returncode == 0 and os.path.exists(os.path.join(folder, longest)) else run.stderr.decode()
    report.add("name of 255 bytes", case, wrong)
    shutil.rmtree(folder)
    os.mkdir(folder)
    report.add("name of 256 bytes", case, case.fault_of(case.run(folder, name="n" + longest), folder))


def can_mount(folder):
    try:
        Disk(folder).close()
        return True
    except (OSError, subprocess.CalledProcessError):
        return False


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", help="pellucid-cli")
    parser.add_argument("--only", default="", help="commands that have this word")
    parser.add_argument("--in-namespace", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    options.program = os.path.abspath(options.program)
    if not os.access(options.program, os.X_OK):
        parser.error("no program: " + options.program)
    if not options.in_namespace and shutil.which("unshare"):
        alone = ["unshare", "--mount"] + ([] if os.geteuid() == 0 else ["--map-root-user"])
        if subprocess.run([*alone, "true"], stderr=subprocess.DEVNULL).returncode == 0:
            os.execvp("unshare", [*alone, sys.executable, *sys.argv, "--in-namespace"])

    faults = [with_limit, with_little_memory, while_it_goes_away, with_long_names]
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        os.chmod(folder, 0o755)
        disk = os.path.join(folder, "disk")
        os.mkdir(disk)
        if can_mount(disk):
            faults += [on_full_disk, on_read_only_disk]
        else:
            report.left_out.append("disks: mounting is not allowed")
        starts_for_nobody = subprocess.run([*AS_NOBODY, options.program, "samples"], capture_output=True).returncode == 0
        if os.geteuid() != 0 or starts_for_nobody:
            faults.append(in_foreign_folder)
        else:
            report.left_out.append("folders of others: nobody else can start the program")
        if os.geteuid() == 0 and starts_for_nobody:
            faults.append(with_few_processes)
        else:
            report.left_out.append("limits on processes: root has to begin this, and somebody else start the program")
        inputs = {}
        for word, command in INPUTS.items():
            inputs[word] = os.path.join(folder, command[-1])
            subprocess.run([options.program, *command[:-1], inputs[word]], check=True, stdout=subprocess.DEVNULL)
        for words, name in COMMANDS:
            if options.only not in " ".join(words):
                continue
            case = Case(options.program, words, name, inputs)
            for fault in faults:
                place = tempfile.mkdtemp(dir=folder)
                os.chmod(place, 0o755)
                fault(case, report, place)
                shutil.rmtree(place, ignore_errors=True)
    for fault, count in report.counts.items():
        print("%-22s %4d" % (fault, count))
    for line in report.left_out:
        print("left out: " + line)
    for line in report.failed:
        print(line)
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
