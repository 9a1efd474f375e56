// Values as bytes, one behind the other: what processes of one program on machines of one kind send each other.
#pragma once

#include <cstddef>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "base/check.h"

namespace pellucid {

template <class T>
void appendBytes(std::vector<std::byte>& bytes, std::span<const T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto more = std::as_bytes(values);
    bytes.insert(bytes.end(), more.begin(), more.end());
}
template <class T>
void appendBytes(std::vector<std::byte>& bytes, const T& value) {
    appendBytes(bytes, std::span<const T>(&value, 1));
}

/// Takes values out again, in the order in which they were appended.
class ByteReader {
public:
    explicit ByteReader(std::span<const std::byte> bytes) : m_left(bytes) {}
    bool atEnd() const { return m_left.empty(); }

    template <class T>
    void take(std::span<T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        PELLUCID_CHECK(values.size_bytes() <= m_left.size());
        if (!values.empty()) std::memcpy(values.data(), m_left.data(), values.size_bytes());
        m_left = m_left.subspan(values.size_bytes());
    }
    template <class T>
    T take() {
        T value{};
        take(std::span<T>(&value, 1));
        return value;
    }

private:
    std::span<const std::byte> m_left;
};

} // namespace pellucid
