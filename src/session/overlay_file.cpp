#include "session/overlay_file.h"

#include <algorithm>

#include "base/round_numbers.h"
#include "render/memory_needs.h"
#include "tf/tf_range.h"
#include "volume/orientation.h"

namespace pellucid {

namespace {

std::string missText(const Geometry& first, double gap) {
    return "the overlay and the volume do not meet: they are at least " + shortText(gap) + " " + lengthUnit(first) +
           " apart";
}

/// What `view` says of the look, the rest as the values propose for as many sides.
OverlayLook lookOf(const SceneOverlay& overlay, const OverlayView& view) {
    using Sides = OverlayView::Sides;
    OverlayLook look = overlay.usual;
    const ValueRange& values = overlay.volume->dataRange();
    if (view.sides == Sides::Two && !look.twoSided) look = twoSidedLook(values);
    if (view.sides == Sides::One && look.twoSided) look = oneSidedLook(values);
    look.threshold = view.threshold.value_or(look.threshold);
    look.top = view.top.value_or(look.top);
    return look;
}

/// The curve over all values; its largest opacity is `opacity`, where that is given.
TransferFunction overValues(TransferFunction curve, const std::optional<double>& opacity, const ValueRange& values) {
    if (!curve.range) curve.range = values;
    double peak = 0;
    for (const ControlPoint& point : curve.points) peak = std::max(peak, point.opacity);
    if (opacity && peak > 0)
        for (ControlPoint& point : curve.points) point.opacity *= *opacity / peak;
    return inRange(curve, values);
}

} // namespace

void dressOverlay(SceneOverlay& overlay, const OverlayView& view) {
    overlay.look = lookOf(overlay, view);
    const ColorMap& colors =
        view.colorMap == OverlayView::kAutomatic ? usualColorMap(overlay.look) : colorMapNamed(view.colorMap);
    const ValueRange& values = overlay.volume->range();
    overlay.tf = view.curve ? overValues(*view.curve, view.opacity, values)
                            : overlayTf(overlay.look, colors, view.opacity.value_or(OverlayView::kUsual), values);
}

SceneOverlay readOverlay(const OverlayView& view, const Geometry& first, const JobControl& job) {
    VolumeSource source = view.source;
    source.range.reset();
    source.then = toView("an overlay of");
    auto volume = std::make_shared<const Volume>(loadVolume(source, job));
    const std::string& where = source.path;
    if (!volume->hasValidVoxels() || volume->isConstant())
        throw FileError("all values of the overlay are the same, so that there is nothing to see of it", where,
                        "choose another file or, of a file with several components, another one of these");
    const OverlayPlace place = overlayPlace(first, inUnit(volume->geometry(), unitOf(first)));
    if (const double gap = boxGap(first, place.geometry); gap > 0)
        throw FileError(missText(first, gap), where,
                        "check that both are of one patient and one coordinate system, or register them first");
    SceneOverlay overlay;
    overlay.usual = usualLook(*volume, job);
    overlay.notices = volume->notices;
    overlay.byCentres = place.byCentres;
    if (place.byCentres)
        overlay.notices.emplace_back("the overlay " + volume->title +
                                     " does not say where it lies: it is centred on the volume");
    overlay.geometry = place.geometry;
    overlay.volume = std::move(volume);
    dressOverlay(overlay, view);
    return overlay;
}

} // namespace pellucid
