// Whether two things are the same, by a short text: not against those who want two to look the same.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>

namespace pellucid {

/// FNV-1a, twice with different starts: 128 bits.
class Digest {
public:
    void add(const void* bytes, std::size_t count) {
        const auto* p = static_cast<const unsigned char*>(bytes);
        for (std::size_t i = 0; i < count; ++i)
            for (std::uint64_t& h : m_state) h = (h ^ p[i]) * 0x100000001b3ull;
    }
    void add(double value) {
        value += 0.0; // −0 is 0
        add(&value, sizeof value);
    }
    template <std::integral Whole>
    void add(Whole value) {
        const auto wide = static_cast<long long>(value);
        add(&wide, sizeof wide);
    }
    void add(const std::string& text) {
        add(text.size());
        add(text.data(), text.size());
    }
    /// 32 digits.
    std::string text() const {
        std::array<char, 40> buffer{};
        std::snprintf(buffer.data(), buffer.size(), "%016llx%016llx", static_cast<unsigned long long>(m_state[0]),
                      static_cast<unsigned long long>(m_state[1]));
        return buffer.data();
    }

private:
    std::array<std::uint64_t, 2> m_state{0xcbf29ce484222325ull, 0x6c62272e07bb0142ull};
};

} // namespace pellucid
