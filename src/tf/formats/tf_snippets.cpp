#include "tf/formats/tf_snippets.h"

#include <array>

#include "base/round_numbers.h"

namespace pellucid {

namespace {

std::string listOf(const std::vector<ControlPoint>& points, const TfToWrite& tf) {
    std::string text = "points = [  # value, red, green, blue, opacity\n";
    for (const ControlPoint& p : points) {
        text += "    (" + exactText(tf.value(p.x));
        for (const double v : {p.color.r, p.color.g, p.color.b, p.opacity}) text += ", " + exactText(v);
        text += "),\n";
    }
    return text + "]\nunit_distance = " + exactText(tf.geometry().d0()) + "  # of the opacities, in world units\n";
}

std::string head(const char* where) { return std::string("# A transfer function of Pellucid, for ") + where + ".\n"; }

/// Two functions of VTK, filled.
constexpr const char* kFunctions = "colors = vtk.vtkColorTransferFunction()\n"
                                   "opacities = vtk.vtkPiecewiseFunction()\n"
                                   "for value, red, green, blue, opacity in points:\n"
                                   "    colors.AddRGBPoint(value, red, green, blue)\n"
                                   "    opacities.AddPoint(value, opacity)\n";

std::string forParaView(const TfToWrite& tf) {
    return head("ParaView's Python shell: the source that is active is drawn as a volume") +
           "from paraview.simple import *\n\n" + listOf(tf.pointsApart({}), tf) +
           "\nview = GetActiveViewOrCreate(\"RenderView\")\n"
           "display = GetDisplayProperties(GetActiveSource(), view=view)\n"
           "name = display.ColorArrayName[1] or GetActiveSource().PointData.GetArray(0).Name\n"
           "ColorBy(display, (\"POINTS\", name))\n"
           "colors = GetColorTransferFunction(name)\n"
           "colors.ColorSpace = \"RGB\"\n"
           "colors.RGBPoints = [v for p in points for v in p[:4]]\n"
           "opacities = GetOpacityTransferFunction(name)\n"
           "opacities.Points = [v for p in points for v in (p[0], p[4], 0.5, 0.0)]\n"
           "display.SetRepresentationType(\"Volume\")\n"
           "display.ScalarOpacityUnitDistance = unit_distance\n"
           "Render(view)\n";
}

std::string forSlicer(const TfToWrite& tf) {
    return head("3D Slicer's Python console: the first volume of the scene is drawn") +
           "import slicer\nimport vtk\n\n" + listOf(tf.pointsApart({}), tf) + "\n" + kFunctions +
           "volume = slicer.mrmlScene.GetFirstNodeByClass(\"vtkMRMLScalarVolumeNode\")\n"
           "logic = slicer.modules.volumerendering.logic()\n"
           "display = logic.GetFirstVolumeRenderingDisplayNode(volume)\n"
           "display = display or logic.CreateDefaultVolumeRenderingNodes(volume)\n"
           "look = display.GetVolumePropertyNode().GetVolumeProperty()\n"
           "look.GetRGBTransferFunction().DeepCopy(colors)\n"
           "look.GetScalarOpacity().DeepCopy(opacities)\n"
           "look.SetScalarOpacityUnitDistance(unit_distance)\n"
           "display.SetVisibility(True)\n";
}

std::string forPyVista(const TfToWrite& tf) {
    return head("PyVista: put the name of your file in") +
           "import pyvista\nimport vtk\n\ngrid = pyvista.read(\"FILE\")\n" + listOf(tf.pointsApart({}), tf) + "\n" +
           kFunctions +
           "look = vtk.vtkVolumeProperty()\n"
           "look.SetInterpolationTypeToLinear()\n"
           "look.SetColor(colors)\n"
           "look.SetScalarOpacity(opacities)\n"
           "look.SetScalarOpacityUnitDistance(unit_distance)\n"
           "mapper = vtk.vtkSmartVolumeMapper()  # add_volume() would bring the values to 0 to 255\n"
           "mapper.SetInputData(grid)\n"
           "volume = vtk.vtkVolume()\n"
           "volume.SetMapper(mapper)\n"
           "volume.SetProperty(look)\n"
           "plotter = pyvista.Plotter()\n"
           "plotter.add_actor(volume)\n"
           "plotter.show()\n";
}

std::string forNapari(const TfToWrite& tf) {
    return head(
               "napari's console: the layer that is selected is drawn; napari takes opacities for those of its steps") +
           "import napari\nimport numpy as np\nfrom napari.utils.colormaps import Colormap\n\n" +
           listOf(tf.pointsApart({}), tf) +
           "\ntable = np.array(points)\n"
           "low, high = table[0, 0], table[-1, 0]\n"
           "viewer = napari.current_viewer()\n"
           "layer = viewer.layers.selection.active\n"
           "layer.colormap = Colormap(colors=table[:, 1:], controls=(table[:, 0] - low) / (high - low), "
           "name=\"pellucid\")\n"
           "layer.contrast_limits = (low, high)\n"
           "layer.rendering = \"translucent\"\n"
           "viewer.dims.ndisplay = 3\n";
}

} // namespace

std::span<const TfSnippet> tfSnippets() {
    static const std::array kSnippets{
        TfSnippet{"paraview", "ParaView", "ParaView's Python shell", true, &forParaView},
        TfSnippet{"slicer", "3D Slicer", "3D Slicer's Python console", true, &forSlicer},
        TfSnippet{"pyvista", "Python (PyVista)", "a Python console with PyVista", true, &forPyVista},
        TfSnippet{"napari", "Python (napari)", "napari's console", false, &forNapari}};
    return kSnippets;
}

WrittenTf writtenTf(const TfSnippet& snippet, const TfToWrite& tf) {
    WrittenTf written{snippet.text(tf), commonLosses(tf)};
    if (snippet.byVtk) addVtkLosses(written.losses, tf.pointsApart({}));
    return written;
}

} // namespace pellucid
