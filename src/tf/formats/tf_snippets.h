// Transfer functions as Python for the consoles of other programs: what somebody copies there and runs.
#pragma once

#include <span>
#include <string>

#include "tf/formats/tf_format.h"

namespace pellucid {

/// All take opacities for paths of d0, and tell the program so where it can be told.
struct TfSnippet {
    const char* name;    ///< "paraview"
    const char* title;   ///< in a list
    const char* console; ///< where it goes, in a sentence: "ParaView's Python shell"
    bool byVtk;          ///< VTK draws it
    std::string (*text)(const TfToWrite& tf);
};

/// With what that loses, as writtenTf() says it of files.
WrittenTf writtenTf(const TfSnippet& snippet, const TfToWrite& tf);

/// For ParaView's and 3D Slicer's own consoles, for PyVista, and for napari.
std::span<const TfSnippet> tfSnippets();

} // namespace pellucid
