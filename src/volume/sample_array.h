// The samples of a volume, wherever they lie.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "base/mapped_file.h"

namespace pellucid {

/// Values that never change, in memory or in a mapped file; copies share them.
template <class T>
class SampleArray {
public:
    using value_type = T;
    static constexpr std::size_t kPadding = MappedFile::kPadding / sizeof(T); ///< values

    SampleArray() = default;
    template <class Allocator = std::allocator<T>>
    SampleArray(std::vector<T, Allocator> values) { // NOLINT: a vector of samples is samples
        auto held = std::make_shared<const std::vector<T, Allocator>>(std::move(values));
        m_data = held->data();
        m_size = held->size();
        m_owner = std::move(held);
    }
    /// The first `count` of `values`; where kPadding more are there, the array is padded.
    template <class Allocator = std::allocator<T>>
    SampleArray(std::vector<T, Allocator> values, std::size_t count) : SampleArray(std::move(values)) {
        m_padded = m_size >= count + kPadding;
        m_size = count;
    }
    /// The values that a mapped file begins with. It is not null, and its first byte lies where a T may.
    explicit SampleArray(std::shared_ptr<const MappedFile> file)
        : m_data(reinterpret_cast<const T*>(file->data())), m_size(file->size() / sizeof(T)), m_mapped(true),
          m_padded(true) {
        m_owner = std::move(file);
    }

    const T* data() const noexcept { return m_data; }
    std::size_t size() const noexcept { return m_size; }
    bool empty() const noexcept { return m_size == 0; }
    const T* begin() const noexcept { return m_data; }
    const T* end() const noexcept { return m_data + m_size; }
    const T& operator[](std::size_t i) const { return m_data[i]; }

    bool isMapped() const noexcept { return m_mapped; } ///< in a file: takes no memory
    bool isPadded() const noexcept { return m_padded; } ///< kPadding values may be read behind the last one

    bool operator==(const SampleArray& other) const {
        return m_size == other.m_size && (m_data == other.m_data || std::equal(begin(), end(), other.begin()));
    }

private:
    std::shared_ptr<const void> m_owner;
    const T* m_data = nullptr;
    std::size_t m_size = 0;
    bool m_mapped = false, m_padded = false;
};

} // namespace pellucid
