#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include "image_io/srgb_profile.h"

using namespace pellucid;

namespace {

std::uint32_t numberAt(const std::vector<unsigned char>& bytes, std::size_t at) {
    return bytes.at(at) * 16777216u + bytes.at(at + 1) * 65536u + bytes.at(at + 2) * 256u + bytes.at(at + 3);
}

/// Where the data of a tag begins; the table begins at 128 with the number of tags.
std::size_t tagAt(const std::vector<unsigned char>& profile, const std::string& name) {
    for (std::size_t t = 0; t < numberAt(profile, 128); ++t) {
        const std::size_t at = 132 + 12 * t;
        if (std::equal(name.begin(), name.end(), profile.begin() + static_cast<std::ptrdiff_t>(at)))
            return numberAt(profile, at + 4);
    }
    FAIL(name);
    return 0;
}

double xyz(const std::vector<unsigned char>& profile, const std::string& tag, std::size_t axis) {
    return static_cast<std::int32_t>(numberAt(profile, tagAt(profile, tag) + 8 + 4 * axis)) / 65536.0;
}

} // namespace

TEST_CASE("the profile of sRGB has its primaries under D50", "[image]") {
    const std::vector<unsigned char> profile = srgbIccProfile();
    CHECK(numberAt(profile, 0) == profile.size());
    CHECK(std::string(profile.begin() + 36, profile.begin() + 40) == "acsp");
    // As published for sRGB adapted to D50 by Bradford's method (Lindbloom), to four places.
    const double expected[3][3] = {{0.4361, 0.2225, 0.0139}, {0.3851, 0.7169, 0.0971}, {0.1431, 0.0606, 0.7141}};
    const std::string tags[] = {"rXYZ", "gXYZ", "bXYZ"};
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t a = 0; a < 3; ++a) CHECK(xyz(profile, tags[c], a) == Approx(expected[c][a]).margin(3e-4));
    // All three together are the white, D50 = (0.9642, 1, 0.8249).
    const double white[] = {0.9642, 1, 0.8249};
    for (std::size_t a = 0; a < 3; ++a)
        CHECK(xyz(profile, tags[0], a) + xyz(profile, tags[1], a) + xyz(profile, tags[2], a) ==
              Approx(white[a]).margin(1e-4));
    CHECK(tagAt(profile, "rTRC") == tagAt(profile, "bTRC"));
    CHECK(numberAt(profile, tagAt(profile, "gTRC") + 8) == 1024);
}
