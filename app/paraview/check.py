"""Runs the plugin as its users would, and compares with pellucid-cli: figures, fields, an optimization, its picture.

Started by scripts/paraview-check.sh; starts itself again under pvbatch, with what to do as JSON.
"""

import argparse
import gzip
import json
import os
import signal
import subprocess
import sys
import time

FIGURE_TOLERANCE = 0.005  # of VWS and visibility
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
       "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}


def in_paraview(task):
    """On every process of pvbatch, or on the client of a server."""
    from paraview import servermanager, simple
    if task.get("port"):
        simple.Connect("localhost", task["port"])
        simple.LoadPlugin(task["plugin"], remote=True)
    else:
        simple.LoadPlugin(task["plugin"], remote=False)
    source = simple.OpenDataFile(task["volume"])
    simple.UpdatePipeline(proxy=source)
    array = source.PointData[0].Name
    seen = simple.PellucidVisibility(Input=source, TransferFunction=task["tf"], Direction=task["view"])
    seen.SelectInputArray = ["POINTS", array]
    seen.UpdatePipeline()
    whole = servermanager.Fetch(seen)
    fields = whole.GetFieldData()
    answer = {"processes": servermanager.ActiveConnection.GetNumberOfDataPartitions()}
    count = fields.GetAbstractArray("feature").GetNumberOfValues()
    count = len({fields.GetAbstractArray("feature").GetValue(i) for i in range(count)})
    answer["features"] = [{"name": fields.GetAbstractArray("feature").GetValue(i),
                           "visibility": fields.GetArray("feature_visibility").GetValue(i),
                           "vws": fields.GetArray("feature_vws").GetValue(i)} for i in range(count)]
    from vtkmodules.util.numpy_support import vtk_to_numpy
    sums = {}
    for name in ["visibility", "saliency", "vws"] + ["vws_" + f["name"] for f in answer["features"]]:
        sums[name] = float(vtk_to_numpy(whole.GetPointData().GetArray(name)).sum(dtype="f8"))
    answer["sums"], answer["dims"] = sums, list(whole.GetDimensions())

    sys.path.insert(0, os.path.join(os.path.dirname(task["script"]), "plugin"))
    import pellucid_apply
    optimize = simple.PellucidOptimize(Input=source, TransferFunction=task["tf"], Targets=task["targets"],
                                       Direction=task["view"])
    optimize.SelectInputArray = ["POINTS", array]
    view = simple.CreateView("RenderView")
    view.ViewSize = [512, 512]
    view.Background = [0, 0, 0]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    simple.Show(source, view)
    simple.ResetCamera(view)
    camera = view.GetActiveCamera()
    camera.Elevation(-70)
    camera.Azimuth(30)
    table = pellucid_apply.apply_answer(source, optimize, view)
    answer["optimized"] = [{name: table.GetValueByName(row, name).ToDouble()
                            for name in ("target", "vws_before", "vws_after", "opacity_after")}
                           for row in range(table.GetNumberOfRows())]
    if task.get("picture"):
        simple.ResetCamera(view)
        simple.Render(view)
        simple.SaveScreenshot(task["picture"], view)
    with open(task["answer"], "w") as file:
        json.dump(answer, file)


def unpack(path):
    """ParaView reads parts of NRRD files only where they are not compressed."""
    with open(path, "rb") as file:
        data = file.read()
    end = data.index(b"\n\n") + 2
    with open(path, "wb") as file:
        file.write(data[:end].replace(b"encoding: gzip", b"encoding: raw") + gzip.decompress(data[end:]))


def run(words, **more):
    return subprocess.run(words, env={**os.environ, **MPI}, check=True, **more)


def difference(expected, answer):
    return max(abs(a[key] - b[key]) for a, b in zip(expected, answer["features"]) for key in ("visibility", "vws"))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--plugin", required=True)
    parser.add_argument("--cli", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--processes", default="1,2,4")
    options = parser.parse_args()
    script, out = os.path.abspath(__file__), os.path.abspath(options.out)
    cases = [("shells", ["shells", "--size", "96"]), ("knee", ["knee", "--size", "240"])]
    display = ["xvfb-run", "-a", "-s", "-screen 0 1024x1024x24"]
    failed = False
    for name, sample in cases:
        volume = os.path.join(out, name + ".nrrd")
        run([options.cli, "generate"] + sample + ["--out", volume], stdout=subprocess.DEVNULL)
        unpack(volume)
        tf, view, targets = "tents:3:0.3", [30, 20], "1,2,3"
        measured = json.loads(run([options.cli, "measure", volume, "--tf", tf, "--view", "30,20", "--json"],
                                  stdout=subprocess.PIPE).stdout)
        best = json.loads(run([options.cli, "optimize", volume, "--tf", tf, "--view", "30,20", "--target", targets,
                               "--json"], stdout=subprocess.PIPE).stdout)
        expected = best["vws"][best["best"]]
        for count in options.processes.split(",") + ["server"]:
            answer = os.path.join(out, "{}_{}.json".format(name, count))
            task = {"plugin": options.plugin, "volume": volume, "tf": tf, "view": view, "targets": targets,
                    "answer": answer, "script": script,
                    "picture": os.path.join(out, "{}_{}.png".format(name, count))}
            if os.path.exists(answer):
                os.remove(answer)
            if count == "server":
                task["port"] = 11111 + os.getpid() % 1000
                server = subprocess.Popen(display + ["mpirun", "-n", "2", "pvserver", "--server-port=%d" % task["port"]],
                                          env={**os.environ, **MPI}, start_new_session=True)
                time.sleep(8)
                try:
                    run(display + ["pvpython", script, json.dumps(task)])
                finally:
                    os.killpg(server.pid, signal.SIGTERM)
            else:
                run(display + ["mpirun", "-n", count, "pvbatch", script, json.dumps(task)])
            got = json.load(open(answer))
            away = difference(measured["features"], got)
            found = max(abs(row["vws_after"] - e) for row, e in zip(got["optimized"], expected))
            whole = abs(got["sums"]["vws"] - 1)
            parts = max(abs(got["sums"]["vws_" + f["name"]] - f["vws"]) for f in got["features"])
            good = (away < FIGURE_TOLERANCE and whole < 1e-3 and parts < 1e-3 and len(got["optimized"]) == 3 and
                    found < 0.02)
            failed |= not good
            print("{} {} {}: figures within {:.5f} of pellucid-cli, vws adds up to 1 within {:.1e} and per feature within "
                  "{:.1e}, optimized within {:.4f}: {}".format(name, count, "processes" if count != "server" else
                                                              "(2 processes)", away, whole, parts, found,
                                                              "good" if good else "NOT GOOD"), flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    if len(sys.argv) == 2 and sys.argv[1].startswith("{"):
        in_paraview(json.loads(sys.argv[1]))
    else:
        main()
