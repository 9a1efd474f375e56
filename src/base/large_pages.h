// Vectors of many values, in large pages of memory.
#pragma once

#include <cstddef>
#include <vector>

namespace pellucid {

/// Asks the system for large pages where `memory` has any; where it refuses, they are small.
void adviseLargePages(void* memory, std::size_t bytes);

/// `count` zeros. Touching memory for the first time is most of what it takes to fill it: large pages make that a few
/// times cheaper.
template <class T>
std::vector<T> zerosInLargePages(std::size_t count) {
    std::vector<T> values;
    values.reserve(count);
    adviseLargePages(values.data(), count * sizeof(T));
    values.resize(count);
    return values;
}

} // namespace pellucid
