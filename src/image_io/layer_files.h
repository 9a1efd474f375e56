// The layers of a picture as files: one EXR file with many channels, or a folder of PNG files.
#pragma once

#include <string>
#include <vector>

#include "base/job.h"
#include "image_io/picture_text.h"
#include "render/picture_layers.h"

namespace pellucid {

/// What features are called in channels and files, in their order: letters, digits and what is harmless in both, at
/// most 64 bytes each, all different, also where large and small letters are one; never empty.
std::vector<std::string> layerNames(const std::vector<Feature>& features);

/// Throws UsageError where `path` has the suffix of another kind of file than .exr: without one it is a folder.
void checkLayersPath(const std::string& path);
bool isLayersFile(const std::string& path); ///< .exr

/// Into an EXR file, in linear light, premultiplied: R G B A is the picture; feature.NAME.R … A what a feature adds to
/// each of these, rest.R … A what lies in none, so that they sum to the picture; depth.Z; normal.X … Z. Or into a
/// folder: picture.png (8 bits, sRGB, straight alpha); feature_NAME.png and rest.png (16 bits, likewise); mask_NAME.png
/// (grey, the share times 65535); depth.png and normal.png (docs/method.md, "Layers"); layers.json says which is which.
/// A folder of that name is replaced where it is one of layers, else it is an error. Throws FileError, Cancelled.
void writeLayers(const PictureLayers& layers, const std::vector<Feature>& features, const std::string& path,
                 const PictureText& text = {}, const JobControl& job = {});

} // namespace pellucid
