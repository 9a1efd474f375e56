// *.1dt, the one-dimensional transfer functions of ImageVis3D: a table of r g b a.
#include <cmath>

#include "base/error.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "tf/formats/foreign_file.h"
#include "tf/formats/read_curves.h"
#include "tf/formats/tf_format.h"

namespace pellucid {

namespace {

constexpr int kEntries = 4096; ///< that are written

std::optional<std::size_t> sizeOf(const ForeignFile& file) {
    std::int64_t size = 0;
    if (file.isJson() || file.isXml() || file.lines().empty() || !parseNumber(trimmed(file.lines().front()), size) ||
        size < 2 || size > static_cast<std::int64_t>(kMostNodes))
        return {};
    return static_cast<std::size_t>(size);
}

bool knowsTable(const ForeignFile& file) {
    return sizeOf(file).has_value() && file.lines().size() > 1 && splitWords(file.lines()[1]).size() == 4;
}

/// A run of one value needs its ends only.
template <class Node, class Value>
void addToRun(std::vector<Node>& nodes, const Node& node, Value Node::*value) {
    const std::size_t n = nodes.size();
    if (n >= 2 && nodes[n - 1].*value == node.*value && nodes[n - 2].*value == node.*value) nodes.pop_back();
    nodes.push_back(node);
}

ReadTf readTable(const ForeignFile& file) {
    const std::optional<std::size_t> size = sizeOf(file);
    if (!size)
        throw FileError("its first line is no number of entries from 2 to 65536", file.path(),
                        "give a transfer function of ImageVis3D, *.1dt");
    if (file.lines().size() <= *size)
        throw FileError("it has " + std::to_string(file.lines().size() - 1) + " of " + std::to_string(*size) +
                            " entries",
                        file.path(), "give the whole file");
    TfCurves curves;
    for (std::size_t i = 0; i < *size; ++i) {
        const std::vector<std::string> words = splitWords(file.lines()[i + 1]);
        const std::string where = file.path() + ", line " + std::to_string(i + 2);
        if (words.size() != 4) throw FileError("four numbers are expected", where, "correct the file");
        std::array<double, 4> v{};
        for (std::size_t k = 0; k < 4; ++k)
            if (!parseNumber(words[k], v[k]) || !std::isfinite(v[k]))
                throw FileError(inQuotes(words[k]) + " is not a number", where, "correct the file");
        const double x = static_cast<double>(i) / static_cast<double>(*size - 1);
        addToRun(curves.colors, ColorNode{x, {v[0], v[1], v[2]}, {}}, &ColorNode::color);
        addToRun(curves.opacities, OpacityNode{x, v[3], {}}, &OpacityNode::opacity);
    }
    ReadTf read = tfOfCurves(curves, ValueRange{0, 1}, file.path());
    read.positions = ValueRange{0, 1};
    read.spansData = true;
    return read;
}

WrittenTf writeTable(const TfToWrite& tf) {
    TransferFunction all;
    all.points = tf.overData().points({});
    const TfSampler sampler(all);
    WrittenTf written;
    written.text = std::to_string(kEntries) + "\n";
    for (int i = 0; i < kEntries; ++i) {
        const double x = i / (kEntries - 1.0);
        const Rgb c = sampler.color(x);
        for (const double v : {c.r, c.g, c.b}) written.text += shortText(v) + " ";
        written.text += plainText(sampler.opacity(x)) + "\n";
    }
    written.losses.emplace_back("all is a table of 4096 entries: steps become slopes of one entry");
    addNoDomainLoss(written.losses, tf, "ImageVis3D");
    return written;
}

} // namespace

TfFormat imageVis3DFormat() {
    return {"imagevis3d", "ImageVis3D", "a transfer function of ImageVis3D",
            ".1dt",       true,         "the data range, features; all is a table of 4096 entries",
            &knowsTable,  &readTable,   &writeTable};
}

} // namespace pellucid
