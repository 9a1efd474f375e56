"""Shows a volume in ParaView as Pellucid finds best.

As a macro: select an image in the pipeline browser, show it as Volume, and run this. It asks "Pellucid: optimize
transfer function" from where the render view looks, with equal shares of attention, and gives colours and opacities to
the representation. Targets or a transfer function of your own: change them in the properties of the filter, and run
the macro again; it uses the filter that is there.
"""

import json

from paraview import servermanager, simple
from paraview.simple import (GetActiveSource, GetActiveViewOrCreate, GetColorTransferFunction, GetDisplayProperties,
                             GetOpacityTransferFunction, Render)


def look_as(view, optimize):
    """The filter sees the volume as the view does."""
    camera = view.GetActiveCamera()
    optimize.ByDirection = 0
    optimize.CameraPosition = camera.GetPosition()
    optimize.CameraFocalPoint = camera.GetFocalPoint()
    optimize.CameraViewUp = camera.GetViewUp()
    optimize.CameraViewAngle = camera.GetViewAngle()
    optimize.ParallelProjection = int(camera.GetParallelProjection())
    optimize.ParallelScale = camera.GetParallelScale()


def apply_answer(source, optimize, view):
    """Gives the answer of the filter to the way in which the source is shown. Returns the table."""
    optimize.UpdatePipeline()
    table = servermanager.Fetch(optimize)
    fields = table.GetFieldData()
    if fields.GetAbstractArray("preset") is None:
        raise RuntimeError("the optimization failed: see the messages of the server")
    preset = json.loads(fields.GetAbstractArray("preset").GetValue(0))[0]
    array = optimize.InputArray[1]
    colors, opacities = GetColorTransferFunction(array), GetOpacityTransferFunction(array)
    colors.AutomaticRescaleRangeMode = "Never"
    colors.ColorSpace = preset["ColorSpace"]
    colors.RGBPoints = preset["RGBPoints"]
    opacities.Points = preset["Points"]
    shown = GetDisplayProperties(source, view)
    shown.Representation = "Volume"
    shown.ColorArrayName = ["POINTS", array]
    shown.LookupTable = colors
    shown.ScalarOpacityFunction = opacities
    shown.ScalarOpacityUnitDistance = fields.GetArray("opacity_unit_distance").GetValue(0)
    return table


def is_optimize(proxy):
    return proxy.GetXMLName() == "PellucidOptimize"


def filter_for(source):
    """The newest filter of ours that takes its image from `source`; a new one where there is none."""
    ours = [proxy for proxy in simple.GetSources().values() if is_optimize(proxy) and proxy.Input == source]
    return ours[-1] if ours else simple.Pellucidoptimizetransferfunction(Input=source)


def main():
    view = GetActiveViewOrCreate("RenderView")
    active = GetActiveSource()
    if active is None:
        raise RuntimeError("select an image in the pipeline browser first")
    source, optimize = (active.Input, active) if is_optimize(active) else (active, filter_for(active))
    look_as(view, optimize)
    table = apply_answer(source, optimize, view)
    for row in range(table.GetNumberOfRows()):
        print("{}: {:.3f} of the attention, {:.3f} asked for".format(
            *(table.GetValueByName(row, name).ToString() if name == "feature" else table.GetValueByName(row, name).ToDouble()
              for name in ("feature", "vws_after", "target"))))
    Render(view)


if __name__ == "__main__":
    main()
