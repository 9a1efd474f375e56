// What shows where a picture is transparent.
#pragma once

#include "base/image.h"
#include "render/render_settings.h"

namespace pellucid {

/// Puts the background of `settings` behind the picture, whose alpha is 1 afterwards; nothing where there is none.
void paintBackground(Image& image, const RenderSettings& settings);

} // namespace pellucid
