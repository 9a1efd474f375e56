// Two states beside each other: what each shows, as a picture and as figures of its features, found by their names.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/image_renderer.h"
#include "render/picture_difference.h"
#include "session/workspace.h"

namespace pellucid {

/// The present state, to be kept beside others.
ComparedState comparedState(const Scene& scene, std::string name);
/// That of a session of whatever data; it has a transfer function.
ComparedState comparedState(const Session& session, std::string name);
/// The session of B: the present one with what its ComparisonView, which has a B, keeps and does not share.
Session comparedSession(const Session& present);

/// What a feature comes to in one of the two states.
struct FeatureFigures {
    std::string name;
    Rgb color;
    bool empty = false;       ///< no voxel has its values
    double vws = 0;           ///< W, [0,1]
    double visibility = 0;    ///< FV, [0,1]
    double opacity = 0;       ///< of its peak
    std::optional<double> fs; ///< 2D feature saliency, [0,1]; empty: nobody has looked at the picture
};

/// What one side is made of.
struct SideInput {
    MeasureInput measure;
    PictureInput picture;
    std::vector<bool> empty;   ///< per feature, see Scene::isEmpty()
    bool withSaliency = false; ///< FeatureFigures::fs, which takes a picture per feature

    bool operator==(const SideInput&) const = default;
};
SideInput sideInput(const Scene& scene, PictureInput picture, bool withSaliency);

struct ComparedSide {
    Image image;
    std::vector<FeatureFigures> features; ///< empty of a picture from a file
};
/// `measures`: of `input.measure`. Throws as ImageRenderer::render() does, and Cancelled.
ComparedSide comparedSide(const SideInput& input, const Measures& measures, ImageRenderer& renderer,
                          const JobControl& job = {});

/// A feature of one name on both sides; empty where a side has none.
struct FeaturePair {
    std::string name;
    std::optional<FeatureFigures> a, b;
    /// On every side that has it.
    bool isEmpty() const { return (!a || a->empty) && (!b || b->empty); }
};
/// By name, the first of a name with the first: those of `a` in their order, then what `b` alone has.
std::vector<FeaturePair> pairsOf(const std::vector<FeatureFigures>& a, const std::vector<FeatureFigures>& b);

/// The figures of features, as they are listed.
struct ComparedFigure {
    const char* key;   ///< in files: "vws"
    const char* words; ///< for people: "VWS"
    std::optional<double> (*of)(const FeatureFigures&);
};
std::span<const ComparedFigure> comparedFigures(); ///< VWS, visibility, 2DFS, opacity

struct Comparison {
    std::string a, b; ///< what people call them
    Image imageA, imageB;
    PictureDifference difference;
    std::vector<FeaturePair> features; ///< empty of two pictures from files
};
/// Throws Error where the pictures differ in size.
Comparison comparisonOf(std::string nameA, ComparedSide a, std::string nameB, ComparedSide b);

/// "SSIM 0.9871, mean delta E 1.234, largest 20.10, 12.3 % of the pixels above 2.3"
std::string wordsOf(const PictureDifference& difference);

} // namespace pellucid
