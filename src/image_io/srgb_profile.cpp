#include "image_io/srgb_profile.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>

#include "tf/lch.h"

namespace pellucid {

namespace {

using Bytes = std::vector<unsigned char>;
using glm::dmat3, glm::dvec3;

/// X, Y, Z of a colour of chromaticity (x, y) with Y = 1.
dvec3 colorAt(double x, double y) { return {x / y, 1, (1 - x - y) / y}; }

/// The profile's reference white, D50, as the ICC has rounded it.
const dvec3 kD50{0.9642, 1, 0.8249};

/// What the three components of linear sRGB add to X, Y, Z under D50, one per column.
dmat3 primariesUnderD50() {
    // IEC 61966-2-1: the primaries of ITU-R BT.709, white D65.
    const dmat3 primaries(colorAt(0.64, 0.33), colorAt(0.30, 0.60), colorAt(0.15, 0.06));
    const dvec3 white = colorAt(0.3127, 0.3290);
    const dvec3 amounts = glm::inverse(primaries) * white; // of each, so that all three together are white
    const dmat3 underD65(primaries[0] * amounts[0], primaries[1] * amounts[1], primaries[2] * amounts[2]);
    // Bradford's cone responses, as the ICC recommends: scaled from the one white to the other. By columns.
    const dmat3 cones(dvec3(0.8951, -0.7502, 0.0389), dvec3(0.2664, 1.7135, -0.0685), dvec3(-0.1614, 0.0367, 1.0296));
    const dvec3 scale = (cones * kD50) / (cones * white);
    const dmat3 scaled(dvec3(scale.x, 0, 0), dvec3(0, scale.y, 0), dvec3(0, 0, scale.z));
    return glm::inverse(cones) * scaled * cones * underD65;
}

void addNumber(Bytes& bytes, std::uint32_t value) {
    for (const int shift : {24, 16, 8, 0}) bytes.push_back(static_cast<unsigned char>(value >> shift));
}
void addShort(Bytes& bytes, std::uint32_t value) {
    for (const int shift : {8, 0}) bytes.push_back(static_cast<unsigned char>(value >> shift));
}
void addName(Bytes& bytes, std::string_view name) {
    for (const char c : name) bytes.push_back(static_cast<unsigned char>(c));
}
/// Signed, 16 bits behind the point.
void addFixed(Bytes& bytes, double value) { addNumber(bytes, static_cast<std::uint32_t>(std::lround(value * 65536))); }

Bytes xyzTag(const dvec3& xyz) {
    Bytes tag;
    addName(tag, "XYZ ");
    addNumber(tag, 0);
    for (int a = 0; a < 3; ++a) addFixed(tag, xyz[a]);
    return tag;
}

Bytes textTag(std::string_view text) {
    Bytes tag;
    addName(tag, "text");
    addNumber(tag, 0);
    addName(tag, text);
    tag.push_back(0);
    return tag;
}

/// textDescriptionType: the ASCII text, then none in Unicode and none for the Macintosh.
Bytes descriptionTag(std::string_view text) {
    Bytes tag;
    addName(tag, "desc");
    addNumber(tag, 0);
    addNumber(tag, static_cast<std::uint32_t>(text.size() + 1));
    addName(tag, text);
    tag.push_back(0);
    constexpr std::size_t kUnicode = 8, kMacintosh = 2 + 1 + 67;
    tag.insert(tag.end(), kUnicode + kMacintosh, 0);
    return tag;
}

Bytes curveTag() {
    constexpr std::uint32_t kEntries = 1024; // readers go straight between them: no 8-bit level comes out wrong
    Bytes tag;
    addName(tag, "curv");
    addNumber(tag, 0);
    addNumber(tag, kEntries);
    for (std::uint32_t i = 0; i < kEntries; ++i)
        addShort(tag, static_cast<std::uint32_t>(
                          std::lround(65535 * linearFromSrgb(static_cast<double>(i) / (kEntries - 1)))));
    return tag;
}

/// One block of data, and the tags that share it.
struct Entry {
    std::vector<std::string_view> names;
    Bytes data;
};

/// All that comes before the tags, 128 bytes; the size of the whole comes first.
Bytes header(std::uint32_t size) {
    Bytes head;
    addNumber(head, size);
    addNumber(head, 0);          // made for no engine of its own
    addNumber(head, 0x02400000); // version 2.4
    for (const std::string_view name : {"mntr", "RGB ", "XYZ "}) addName(head, name);
    for (const std::uint32_t part : {2000u, 1u, 1u, 0u, 0u, 0u}) addShort(head, part); // a date must be there
    addName(head, "acsp");
    head.resize(68, 0); // no platform, flags, device or attributes; perceptual
    for (int a = 0; a < 3; ++a) addFixed(head, kD50[a]);
    head.resize(128, 0);
    return head;
}

} // namespace

std::vector<unsigned char> srgbIccProfile() {
    const dmat3 primaries = primariesUnderD50();
    const std::vector<Entry> entries{{{"desc"}, descriptionTag("sRGB (IEC 61966-2-1)")},
                                     {{"cprt"}, textTag("No copyright, use freely")},
                                     {{"wtpt"}, xyzTag(kD50)},
                                     {{"rXYZ"}, xyzTag(primaries[0])},
                                     {{"gXYZ"}, xyzTag(primaries[1])},
                                     {{"bXYZ"}, xyzTag(primaries[2])},
                                     {{"rTRC", "gTRC", "bTRC"}, curveTag()}};
    std::uint32_t tags = 0;
    for (const Entry& entry : entries) tags += static_cast<std::uint32_t>(entry.names.size());
    constexpr std::uint32_t kHeader = 128, kPerTag = 12;
    const std::uint32_t begin = kHeader + 4 + kPerTag * tags;
    Bytes table, data;
    addNumber(table, tags);
    for (const Entry& entry : entries) {
        for (const std::string_view name : entry.names) {
            addName(table, name);
            addNumber(table, begin + static_cast<std::uint32_t>(data.size()));
            addNumber(table, static_cast<std::uint32_t>(entry.data.size()));
        }
        data.insert(data.end(), entry.data.begin(), entry.data.end());
        data.resize((data.size() + 3) / 4 * 4, 0);
    }
    Bytes profile = header(begin + static_cast<std::uint32_t>(data.size()));
    profile.insert(profile.end(), table.begin(), table.end());
    profile.insert(profile.end(), data.begin(), data.end());
    return profile;
}

} // namespace pellucid
