#!/usr/bin/env python3
"""The answer of pellucid-gpu-check as a table for docs/performance.md: gpu_table.py FILE [FILE...]"""
import json
import sys


def seconds_text(seconds):
    if seconds is None:
        return ""
    return f"{1e3 * seconds:.3g} ms" if seconds < 1 else f"{seconds:.3g} s"


def label(row):
    text = f"`{row['name']}`"
    if row["name"] == "sweep":
        text += f", {row['candidates']} TF" + ("s" if row["candidates"] > 1 else "")
    if row["name"] == "jacobian":
        text += f", {row['features']} features"
    if row["name"] == "render":
        text += ", {} × {}".format(*row["size"]) + (", lit" if row.get("lit") else "")
    return text


def table(answer):
    gl, machine, summary = answer["gl"], answer["machine"], answer["summary"]
    lines = []
    if gl is None:
        lines.append(f"No OpenGL: {answer['gl_problem']}")
    else:
        software = " (software, no GPU)" if gl["software"] else ""
        lines.append(f"{gl['renderer']}{software}, OpenGL {gl['version']}; {machine['processor']}, "
                     f"{machine['threads']} threads. {summary['passed']} tests passed, {summary['failed']} failed, "
                     f"{summary['skipped']} skipped.")
    lines += ["", "| row | volume | TF | CPU | OpenGL | CPU / OpenGL |", "|---|---|---|---|---|---|"]
    times = {}  # the last one per engine is that of all threads
    for row in answer["rows"]:
        key = (label(row), row["volume"], row.get("tf", ""))
        times.setdefault(key, {})[row["engine"]] = row["seconds"]
    for (name, volume, tf), by_engine in times.items():
        cpu, on_gl = by_engine.get("cpu"), by_engine.get("gl")
        ratio = f"{cpu / on_gl:.1f}" if cpu and on_gl else ""
        lines.append(f"| {name} | `{volume}` | {tf} | {seconds_text(cpu)} | {seconds_text(on_gl)} | {ratio} |")
    lines += [""] + [f"- {notice}" for notice in answer["notices"]]
    return "\n".join(lines).rstrip()


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as file:
            print(table(json.load(file)), end="\n\n")


if __name__ == "__main__":
    main()
