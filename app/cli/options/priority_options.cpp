#include "options/priority_options.h"

#include <cmath>

#include "render/render_settings.h"

namespace pellucid::cli {

namespace {

PixelRectangle parseRectangle(const std::string& text, const std::string& option) {
    const std::vector<double> v = parseReals(text, option, 4, "X0,Y0,X1,Y1 in pixels");
    for (const double pixel : v)
        if (!(pixel >= 0 && pixel <= kMostPixels && pixel == std::floor(pixel)))
            throw UsageError("'" + text + "' does not name a region of a picture", option,
                             "give whole numbers of pixels");
    const PixelRectangle r{static_cast<int>(v[0]), static_cast<int>(v[1]), static_cast<int>(v[2]),
                           static_cast<int>(v[3])};
    if (r.x0 >= r.x1 || r.y0 >= r.y1)
        throw UsageError("the region '" + text + "' holds no pixel", option,
                         "give X0,Y0,X1,Y1 with X0 < X1 and Y0 < Y1, y down");
    return r;
}

ImageRegion regionOf(const PixelRectangle& r, const ImageSize& size) {
    const double w = size.width, h = size.height;
    return {{{r.x0 / w, r.y0 / h}, {r.x1 / w, r.y0 / h}, {r.x1 / w, r.y1 / h}, {r.x0 / w, r.y1 / h}}};
}

/// As corners in fractions of the picture.
Json jsonFromRegion(const ImageRegion& region) {
    Json corners = Json::array();
    for (const glm::dvec2& corner : region.outline) corners.push_back({corner.x, corner.y});
    return corners;
}

} // namespace

void PriorityOptions::add(CLI::App& app, VolumeOptions& volume) {
    addValue(app, "--intensity", "X", intensity, realFrom(0, 1),
             "prioritize what is near this intensity, from 0 to 1 (the ends of the range)");
    addValue(app, "--hue", "DEG", hue, parseReal,
             "prioritize the intensity whose colour is nearest in hue, in degrees: a click on the palette");
    volume.addRegionOfBoth(
        app, [this](const std::string& text, const std::string& option) { region = parseRectangle(text, option); },
        "X0,Y0,X1,Y1",
        "four numbers: prioritize what has the colours of these pixels of the picture, y down, the last ones not "
        "included; three intervals: only these voxels of the data");
}

const char* PriorityOptions::given() const {
    return intensity ? "--intensity" : hue ? "--hue" : region ? "--region X0,Y0,X1,Y1" : nullptr;
}

void PriorityOptions::check(const ImageSize& size) const {
    if ((intensity ? 1 : 0) + (hue ? 1 : 0) + (region ? 1 : 0) > 1)
        throw UsageError("more than one priority is given", "--intensity, --hue and --region", "leave one of them");
    if (region && (region->x1 > size.width || region->y1 > size.height))
        throw UsageError("the region lies outside the picture of " + std::to_string(size.width) + " x " +
                             std::to_string(size.height) + " pixels",
                         "--region", "correct it, or give the picture's --size WxH");
}

void PriorityOptions::applyTo(RefineSettings& settings, const ImageSize& size) const {
    if (given() == nullptr) return;
    settings.favourNothing();
    settings.intensity = intensity;
    settings.hue = hue;
    if (!region) return;
    settings.region = regionOf(*region, size);
    settings.regionSize = {size.width, size.height};
}

Json PriorityOptions::told(const RefineSettings& settings, const RefinePriority& priority) const {
    if (!settings.favoursAny()) return {{"kind", "none"}};
    if (!settings.region) {
        Json json{{"kind", priority.intensity ? "intensity" : "hue"}};
        if (priority.intensity) json["intensity"] = *priority.intensity;
        if (settings.hue) json["hue"] = *settings.hue;
        return json;
    }
    double pixels = 0;
    for (const RegionColor& c : priority.region) pixels += c.count;
    Json json{{"kind", "region"}};
    if (region)
        json["region"] = {region->x0, region->y0, region->x1, region->y1};
    else
        json["outline"] = jsonFromRegion(*settings.region);
    json["size"] = regionPictureSize(settings);
    json["pixels"] = static_cast<long long>(pixels);
    return json;
}

std::string textOfPriority(const Json& told) {
    if (told["kind"] == "region") return countText(told["pixels"].get<std::size_t>()) + " pixels of a region";
    if (told["kind"] == "none") return "none";
    std::string text;
    if (told.contains("intensity")) text = "intensity " + plainText(told["intensity"].get<double>());
    if (told.contains("hue")) text += (text.empty() ? "hue " : ", hue ") + plainText(told["hue"].get<double>());
    return text;
}

} // namespace pellucid::cli
