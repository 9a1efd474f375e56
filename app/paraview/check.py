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
FIELD_TOLERANCE = 1e-3  # of the largest value
KEEP_PIECE = """
import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkParallelCore import vtkMultiProcessController
piece = self.GetInputDataObject(0, 0)
points = piece.GetPointData()
kept = {{points.GetArrayName(i): vtk_to_numpy(points.GetArray(i)) for i in range(points.GetNumberOfArrays())}}
numpy.savez("{stem}_piece%d.npz" % vtkMultiProcessController.GetGlobalController().GetLocalProcessId(),
            extent=piece.GetExtent(), **kept)
"""
MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
       "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none"}


def in_paraview(task):
    """In pvbatch, whose first process runs scripts, or on the client of a server."""
    from paraview import servermanager, simple
    if task.get("port"):
        simple.Connect("127.0.0.1", task["port"])
        simple.LoadPlugin(task["plugin"], remote=True)
    else:
        simple.LoadPlugin(task["plugin"], remote=False)
    source = simple.OpenDataFile(task["volume"])
    simple.UpdatePipeline(proxy=source)
    array = source.PointData[0].Name
    seen = simple.Pellucidvisibilityandsaliency(Input=source, TransferFunction=task["tf"], Direction=task["view"])
    seen.InputArray = ["POINTS", array]
    seen.UpdatePipeline()
    keep = simple.ProgrammableFilter(Input=seen, OutputDataSetType="Same as Input", CopyArrays=0,
                                     Script=KEEP_PIECE.format(stem=task["answer"][:-len(".json")]))
    keep.UpdatePipeline()
    fields = servermanager.Fetch(seen).GetFieldData()
    names = fields.GetAbstractArray("feature")
    count = len({names.GetValue(i) for i in range(names.GetNumberOfValues())})
    answer = {"features": [{"name": names.GetValue(i), "visibility": fields.GetArray("feature_visibility").GetValue(i),
                            "vws": fields.GetArray("feature_vws").GetValue(i)} for i in range(count)]}

    sys.path.insert(0, os.path.join(os.path.dirname(task["script"]), "plugin"))
    import pellucid_apply
    optimize = simple.Pellucidoptimizetransferfunction(Input=source, TransferFunction=task["tf"], Targets=task["targets"],
                                       Direction=task["view"])
    optimize.InputArray = ["POINTS", array]
    if pellucid_apply.filter_for(source) != optimize:
        raise RuntimeError("the macro does not find the filter that is there")
    if task.get("picture"):
        view = simple.CreateView("RenderView")
        view.ViewSize = [512, 512]
        view.Background = [0, 0, 0]
        view.UseColorPaletteForBackground = 0
        view.OrientationAxesVisibility = 0
        simple.Show(source, view)
        table = pellucid_apply.apply_answer(source, optimize, view)
        camera = view.GetActiveCamera()
        center = [sum(source.GetDataInformation().GetBounds()[2 * a:2 * a + 2]) / 2 for a in range(3)]
        camera.SetFocalPoint(*center)
        camera.SetPosition(center[0] + 1, center[1] - 2, center[2] + 0.8)
        camera.SetViewUp(0, 0, 1)
        simple.ResetCamera(view)
        simple.Render(view)
        simple.SaveScreenshot(task["picture"], view)
    else:
        optimize.UpdatePipeline()
        table = servermanager.Fetch(optimize)
    answer["optimized"] = [{name: table.GetValueByName(row, name).ToDouble()
                            for name in ("target", "vws_before", "vws_after", "opacity_after")}
                           for row in range(table.GetNumberOfRows())]
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


def field_difference(folder, stem):
    """The largest difference of the fields of all pieces, of the largest value; and how many points there are."""
    import glob
    import numpy
    whole, away, points = {}, 0, None
    for name in ("visibility", "saliency", "vws"):
        with open(os.path.join(folder, name + ".nrrd"), "rb") as file:
            data = file.read()
        end = data.index(b"\n\n") + 2
        dims = [int(n) for line in data[:end].splitlines() if line.startswith(b"sizes:") for n in line.split()[1:]]
        whole[name] = numpy.frombuffer(gzip.decompress(data[end:]), "<f4").reshape(dims[::-1])
    for path in glob.glob(glob.escape(stem) + "_piece*.npz"):
        piece = numpy.load(path)
        x0, x1, y0, y1, z0, z1 = piece["extent"]
        points = numpy.zeros_like(whole["vws"], bool) if points is None else points
        if x1 < x0:
            continue
        points[z0:z1 + 1, y0:y1 + 1, x0:x1 + 1] = True
        for name, values in whole.items():
            expected = values[z0:z1 + 1, y0:y1 + 1, x0:x1 + 1]
            away = max(away, abs(piece[name].reshape(expected.shape) - expected).max() / values.max())
    return away, bool(points.all())


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
    display = [] if os.environ.get("DISPLAY") else ["xvfb-run", "-a", "-s", "-noreset -screen 0 1024x1024x24"]
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
        fields = os.path.join(out, name + "_fields")
        run([options.cli, "fields", volume, "--tf", tf, "--view", "30,20", "--field", "visibility", "--field", "saliency",
             "--field", "vws", "--out", fields], stdout=subprocess.DEVNULL)
        for count in options.processes.split(",") + ["server"]:
            answer = os.path.join(out, "{}_{}.json".format(name, count))
            task = {"plugin": options.plugin, "volume": volume, "tf": tf, "view": view, "targets": targets,
                    "answer": answer, "script": script}
            if count in ("1", "server"):
                task["picture"] = answer[:-len(".json")] + ".png"
            for old in [answer] + [answer[:-len(".json")] + "_piece%d.npz" % n for n in range(8)]:
                if os.path.exists(old):
                    os.remove(old)
            if count == "server":
                task["port"] = 11111 + os.getpid() % 1000
                server = subprocess.Popen(display + ["mpirun", "-n", "2", "pvserver", "--server-port=%d" % task["port"]],
                                          env={**os.environ, **MPI}, start_new_session=True)
                time.sleep(20)  # until it listens; a try to connect would be taken for a client
                try:
                    run(display + ["pvpython", script, json.dumps(task)])
                finally:
                    os.killpg(server.pid, signal.SIGTERM)
            else:
                run(display + ["mpirun", "-n", count, "pvbatch", script, json.dumps(task)])
            got = json.load(open(answer))
            away = difference(measured["features"], got)
            found = max(abs(row["vws_after"] - e) for row, e in zip(got["optimized"], expected))
            fields_away, complete = field_difference(fields, answer[:-len(".json")])
            good = (away < FIGURE_TOLERANCE and fields_away < FIELD_TOLERANCE and complete and
                    len(got["optimized"]) == len(expected) and found < 0.02)
            failed |= not good
            print("{}, {}: figures within {:.5f} of pellucid-cli, fields within {:.1e} of their largest value{}, "
                  "optimized within {:.4f}: {}".format(
                      name, "pvserver with 2 processes" if count == "server" else "pvbatch with {}".format(count), away,
                      fields_away, "" if complete else ", INCOMPLETE", found, "good" if good else "NOT GOOD"), flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    if len(sys.argv) == 2 and sys.argv[1].startswith("{"):
        in_paraview(json.loads(sys.argv[1]))
    else:
        main()
