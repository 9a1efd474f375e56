#include "options/ruler_options.h"

#include "parse.h"

namespace pellucid::cli {

namespace {

constexpr const char* kPoint = "X,Y,Z";

std::vector<Vec3> parsePoints(const std::string& text, const std::string& option, std::size_t count,
                              const std::string& form) {
    const auto parts = split(text, ':');
    if (parts.size() != count)
        throw UsageError("'" + text + "' has " + std::to_string(parts.size()) + " of " + std::to_string(count) +
                             " points",
                         option, "give " + form);
    std::vector<Vec3> points;
    for (const std::string& part : parts) {
        const auto v = parseReals(part, option, 3, kPoint);
        points.emplace_back(v[0], v[1], v[2]);
    }
    return points;
}

Ruler checked(Ruler ruler, const std::string& option) {
    if (const std::string problem = rulerProblem(ruler); !problem.empty())
        throw UsageError(problem, option, "give other points");
    return ruler;
}

Ruler parseDistance(const std::string& text, const std::string& option) {
    return checked({.kind = RulerKind::Distance, .points = parsePoints(text, option, 2, "X,Y,Z:X,Y,Z")}, option);
}

Ruler parseAngle(const std::string& text, const std::string& option) {
    return checked({.kind = RulerKind::Angle, .points = parsePoints(text, option, 3, "X,Y,Z:X,Y,Z:X,Y,Z")}, option);
}

Ruler parseSphere(const std::string& text, const std::string& option) {
    const auto v = parseReals(text, option, 4, "X,Y,Z,R");
    if (!(v[3] > 0)) throw UsageError("the radius of the sphere is not above 0", option, "give X,Y,Z,R with R > 0");
    return {.kind = RulerKind::Sphere, .points = {{v[0], v[1], v[2]}}, .radius = v[3]};
}

Ruler parseBox(const std::string& text, const std::string& option) {
    const auto corners = parsePoints(text, option, 2, "two opposite corners, X,Y,Z:X,Y,Z");
    return boxRuler(corners[0], corners[1]);
}

} // namespace

void RulerOptions::add(CLI::App& app) {
    const char* const group = "Measures";
    addRepeated(app, "--distance", "A:B", given, parseDistance,
                "the distance of two points of the world, each X,Y,Z as probe tells them; repeatable", group);
    addRepeated(app, "--angle", "A:B:C", given, parseAngle,
                "the angle at B between the ways to A and C, in degrees; repeatable", group);
    addRepeated(app, "--sphere", "X,Y,Z,R", given, parseSphere,
                "the values within R of a point: of the voxels whose centres lie there; repeatable", group);
    addRepeated(app, "--box", "A:B", given, parseBox,
                "the values between two opposite corners, along the axes of the world; repeatable", group);
}

void RulerOptions::applyTo(std::vector<Ruler>& rulers, PatientAxes axes, const Geometry& geometry) const {
    if (rulers.size() + given.size() > kMostRulers)
        throw UsageError("these are more than " + std::to_string(kMostRulers) + " measures", "--distance",
                         "measure some of them in another call");
    for (const Ruler& ruler : given) addRuler(rulers, inAxes(axes, geometry, ruler));
}

} // namespace pellucid::cli
