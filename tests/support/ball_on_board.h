// A ball that lies on a board, as a scanner has it.
#pragma once

#include <cmath>
#include <string>

namespace pellucid::test {

/// The voxels of a headerless file of 40³ u8: a ball of radius 12 on a board of 3 voxels at low y, which runs along z.
/// Both have values around 160, what is around them such below 5.
inline std::string ballOnBoard() {
    std::string bytes;
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 40; ++j)
            for (int i = 0; i < 40; ++i) {
                const bool board = j < 3 && i >= 2 && i < 38;
                const bool ball = std::hypot(i - 19.5, j - 14.5, k - 19.5) < 12;
                bytes.push_back(static_cast<char>(board || ball ? 150 + 20 * ((i + j + k) % 2) : (i * j + k) % 5));
            }
    return bytes;
}

} // namespace pellucid::test
