// Headers of DICOM pictures, as GDCM has read them, put in order. Each 16 bytes are a picture.
#include "foreign/dicom_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fuzz_input.h"

using namespace pellucid;
using namespace pellucid::fuzz;

namespace {

constexpr std::size_t kBytesEach = 16, kMostPictures = 200;
using Bytes = const std::uint8_t*;

/// Whole numbers, and a few that are at the end of what numbers hold: readDicomHeader() lets finite ones through.
double numberFrom(std::uint8_t byte) {
    constexpr std::array kOdd{1e-300,
                              -1e-300,
                              1e300,
                              -1e300,
                              1e-9,
                              1e9,
                              std::numeric_limits<double>::denorm_min(),
                              std::numeric_limits<double>::max()};
    return byte < 248 ? (byte - 124) * 0.5 : kOdd[byte - 248u];
}

/// `all` is of the whole stack, `own` of this picture: stackOf() gets pictures of one size and direction.
DicomFrame pictureFrom(Bytes all, Bytes own) {
    DicomFrame frame;
    frame.file = std::to_string(own[0]);
    frame.frame = own[1];
    if (own[2] % 2 == 0) frame.instanceUid = std::to_string(own[2]);
    frame.instanceNumber = own[3];
    frame.pixels.columns = frame.pixels.rows = 4;
    const Vec3 x = all[0] % 2 == 0 ? Vec3(1, 0, 0) : Vec3(0, 0.8, -0.6);
    if (all[0] < 224) frame.axes = {x, Vec3(0, 0.6, 0.8)};
    if (all[0] % 2 == 0 && frame.axes) frame.axes = {x, Vec3(0, 1, 0)};
    if (all[1] < 224) frame.spacing = {std::abs(numberFrom(all[1])) + 1e-6, 0.5};
    frame.thickness = numberFrom(all[2]);
    if (own[4] < 240) frame.position = Vec3(numberFrom(own[5]), numberFrom(own[6]), numberFrom(own[7]));
    for (std::size_t t = 0; t < kDicomTimes; ++t)
        if (own[8 + t % 8] != 0) frame.times[t] = numberFrom(own[8 + t % 8]);
    return frame;
}

void requireWhole(const DicomStack& stack, std::size_t pictures) {
    require(!stack.steps.empty(), "there is a step");
    require(stack.times.empty() || stack.times.size() == stack.steps.size(), "all steps have a time, or none has");
    require(stack.geometry.dims.z >= 1, "there is a layer");
    for (const std::vector<DicomLayer>& step : stack.steps) {
        require(static_cast<int>(step.size()) == stack.geometry.dims.z, "a step has all layers");
        for (const DicomLayer& layer : step) {
            require(layer.before < pictures && layer.after < pictures, "layers are pictures that there are");
            require(layer.toAfter >= 0 && layer.toAfter < 1, "layers lie between their pictures");
        }
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2 * kBytesEach) return 0;
    std::vector<DicomFrame> frames;
    for (std::size_t at = kBytesEach; at + kBytesEach <= size && frames.size() < kMostPictures; at += kBytesEach)
        frames.push_back(pictureFrom(data, data + at));
    succeeds([&] { requireWhole(stackOf(frames, "a folder"), frames.size()); });
    return 0;
}
