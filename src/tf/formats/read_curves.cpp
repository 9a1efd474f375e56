#include "tf/formats/read_curves.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace pellucid {

namespace {

/// Whether `value` had to be cut to [0,1].
bool cut(double& value) {
    const double before = value;
    value = std::clamp(value, 0.0, 1.0);
    return value != before;
}

void cutValues(TfCurves& curves, std::vector<std::string>& notices) {
    bool any = false;
    for (ColorNode& n : curves.colors)
        for (double* v : {&n.color.r, &n.color.g, &n.color.b}) any = cut(*v) || any;
    for (OpacityNode& n : curves.opacities) any = cut(n.opacity) || any;
    if (any) notices.emplace_back("colours and opacities outside 0 to 1 are cut to it");
}

/// Where x counts by its logarithm there is none of 0 or less.
void straightenLogarithm(TfCurves& curves, std::vector<std::string>& notices) {
    if (!curves.isLogarithmic) return;
    if (curves.range().lo > 0) {
        notices.emplace_back("the logarithmic scale has been converted: positions are those of the values themselves");
        return;
    }
    curves.isLogarithmic = false;
    notices.emplace_back("a logarithmic scale cannot begin at 0 or below: the linear one is taken");
}

void addMissing(TfCurves& curves, ReadTf& read) {
    const ValueRange range = curves.range();
    if (curves.opacities.empty()) {
        read.hasOpacities = false;
        curves.opacities = {{range.lo, range.lo < range.hi ? 0.0 : 1.0, {}}, {range.hi, 1, {}}};
        read.notices.emplace_back("the file has colours only: opacities rise from 0 at its lowest value to 1 at its "
                                  "highest");
    }
    if (curves.colors.empty()) {
        read.hasColors = false;
        read.notices.emplace_back("the file has opacities only: all is white");
    }
}

void place(const TfCurves& curves, const std::optional<ValueRange>& positions, ReadTf& read) {
    const ValueRange range = positions.value_or(curves.range());
    if (!(range.lo < range.hi)) {
        const double opacity = opacityAt(curves, range.lo);
        const Rgb color = colorAt(curves, range.lo);
        read.tf.points = {{0, opacity, color, opacity == 0, {}}, {1, opacity, color, opacity == 0, {}}};
        read.notices.emplace_back("there is one point, which holds for all values");
        return;
    }
    CurvePoints points = pointsOf(curves, range);
    read.tf.points = std::move(points.points);
    if (points.areResampled)
        read.notices.emplace_back("lines that are not straight are followed by more points, to within 1 of delta E and "
                                  "0.002 of opacity");
    if (!positions) read.tf.range = range;
}

} // namespace

ReadTf tfOfCurves(TfCurves curves, const std::optional<ValueRange>& positions, const std::string& path) {
    if (curves.colors.empty() && curves.opacities.empty())
        throw FileError("there are no points in it", path, "give a transfer function with colours or opacities");
    if (curves.colors.size() > kMostNodes || curves.opacities.size() > kMostNodes)
        throw FileError("there are more than " + std::to_string(kMostNodes) + " points in it", path,
                        "give a smaller one");
    if (curves.space == ColorSpace::Ciede2000 && curves.colors.size() > kMostCiede2000Nodes)
        throw FileError("there are more than " + std::to_string(kMostCiede2000Nodes) +
                            " colours in it, and they are mixed by CIEDE2000",
                        path, "give fewer, or another colour space");
    ReadTf read;
    curves.sort();
    cutValues(curves, read.notices);
    straightenLogarithm(curves, read.notices);
    addMissing(curves, read);
    const ValueRange all = positions.value_or(curves.range());
    if (!std::isfinite(all.hi - all.lo)) throw FileError("its values are too far apart", path, "correct the file");
    place(curves, positions, read);
    read.tf.features = deriveFeatures(read.tf);
    read.tf.validate();
    return read;
}

} // namespace pellucid
