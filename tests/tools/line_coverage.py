#!/usr/bin/env python3
"""Which lines of src/ and app/ the tests have run, by folder and by file.

    cmake --preset dev-coverage && cmake --build --preset dev-coverage && ctest --preset dev-coverage
    line_coverage.py build/dev-coverage [--files 20]

Reads what a build with --coverage has left, with the gcov of the compiler. Needs Python 3.8 and nothing beside it.
"""

import argparse
import collections
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def counts_of(build):
    """{file: {line: how often it ran}}: a line of a template or header counts where any translation unit ran it."""
    counts = collections.defaultdict(dict)
    notes = sorted(pathlib.Path(build).resolve().rglob("*.gcda"))
    if not notes:
        sys.exit(f"{build}: no *.gcda there: build with the preset dev-coverage and run the tests")
    with tempfile.TemporaryDirectory() as folder:
        for start in range(0, len(notes), 50):
            subprocess.run(["gcov", "--json-format", "--hash-filenames"] + [str(n) for n in notes[start:start + 50]],
                           cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for path in pathlib.Path(folder).glob("*.gcov.json.gz"):
            with gzip.open(path, "rt") as stream:
                report = json.load(stream)
            working = pathlib.Path(report["current_working_directory"])
            for file in report["files"]:
                source = (working / file["file"]).resolve()
                if not source.is_relative_to(ROOT):
                    continue
                name = source.relative_to(ROOT).as_posix()
                if not name.startswith(("src/", "app/")):
                    continue
                for line in file["lines"]:
                    lines = counts[name]
                    lines[line["line_number"]] = lines.get(line["line_number"], 0) + line["count"]
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", help="the build folder")
    parser.add_argument("--files", type=int, default=20, help="how many files to list, by lines that did not run")
    arguments = parser.parse_args()
    folders, missed = collections.defaultdict(lambda: [0, 0]), []
    for name, lines in counts_of(arguments.build).items():
        ran = sum(1 for count in lines.values() if count > 0)
        missed.append((len(lines) - ran, len(lines), name))
        for folder in (str(pathlib.PurePosixPath(name).parent), "all"):
            folders[folder][0] += ran
            folders[folder][1] += len(lines)
    for folder, (ran, all_lines) in sorted(folders.items()):
        print(f"{100 * ran / all_lines:6.1f} %  {ran:6} of {all_lines:6}  {folder}")
    print("\nnot run, of all, file")
    for gone, all_lines, name in sorted(missed, reverse=True)[:arguments.files]:
        print(f"{gone:7} {all_lines:7}  {name}")


if __name__ == "__main__":
    main()
