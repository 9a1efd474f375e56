// Packs bytes as DDS, written from the format's description.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

namespace pellucid::test {

/// Bits, the highest first.
class BitWriter {
public:
    void add(unsigned value, int count) {
        for (int i = count - 1; i >= 0; --i) {
            if (m_used % 8 == 0) m_bytes += '\0';
            m_bytes.back() = static_cast<char>(m_bytes.back() | (value >> i & 1) << (7 - m_used % 8));
            ++m_used;
        }
    }
    const std::string& bytes() const { return m_bytes; }

private:
    std::string m_bytes;
    int m_used = 0;
};

/// The bytes plane by plane, in blocks of `block` bytes of each plane; 0: in one.
inline std::string inPlanes(const std::string& bytes, std::size_t planes, std::size_t block) {
    std::string text;
    const std::size_t each = block == 0 ? bytes.size() : block * planes;
    for (std::size_t begin = 0; begin < bytes.size(); begin += each)
        for (std::size_t n = 0; n < planes; ++n)
            for (std::size_t i = begin + n; i < std::min(begin + each, bytes.size()); i += planes) text += bytes[i];
    return text;
}

/// A DDS stream of `bytes`.
inline std::string dds(const std::string& bytes, std::size_t planes = 1, std::size_t strip = 1, bool inBlocks = false) {
    const std::string flat = inPlanes(bytes, planes, inBlocks ? std::size_t{1} << 24 : 0);
    std::vector<int> differences;
    for (std::size_t i = 0; i < flat.size(); ++i) {
        const auto at = [&](std::size_t n) { return static_cast<int>(static_cast<unsigned char>(flat[n])); };
        int predicted = i > 0 ? at(i - 1) : 0;
        if (strip > 1 && i > strip) predicted += at(i - strip) - at(i - strip - 1);
        differences.push_back(static_cast<int>(static_cast<signed char>(at(i) - predicted)));
    }
    BitWriter out;
    out.add(static_cast<unsigned>(planes - 1), 2);
    out.add(static_cast<unsigned>(strip - 1), 16);
    for (std::size_t i = 0; i < differences.size();) {
        const auto width = [](int difference) {
            if (difference == 0) return 0;
            int bits = 2;
            while (difference < -(1 << (bits - 1)) || difference >= 1 << (bits - 1)) ++bits;
            return bits;
        };
        const int bits = width(differences[i]);
        std::size_t end = i;
        while (end < differences.size() && end - i < 127 && width(differences[end]) == bits) ++end;
        out.add(static_cast<unsigned>(end - i), 7);
        out.add(static_cast<unsigned>(bits == 0 ? 0 : bits - 1), 3);
        for (; i < end && bits == 0; ++i) continue;
        for (; i < end; ++i) out.add(static_cast<unsigned>(differences[i] + (1 << bits >> 1)), bits);
    }
    out.add(0, 7);
    return std::string(inBlocks ? "DDS v3e\n" : "DDS v3d\n") + out.bytes();
}

} // namespace pellucid::test
