// What files load as, or why they do not.
#pragma once

#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "base/error.h"
#include "volume/loader.h"

namespace pellucid::test {

template <class T>
std::vector<T> samplesOf(const Volume& volume) {
    const auto& samples = std::get<SampleArray<T>>(volume.samples());
    return {samples.begin(), samples.end()};
}

/// The message, which names a place and is one line; "no error" where the file loads.
inline std::string errorOf(const VolumeSource& source) {
    try {
        static_cast<void>(loadVolume(source));
    } catch (const FileError& e) {
        CHECK(!e.where().empty());
        CHECK(std::string(e.what()).find('\n') == std::string::npos);
        return e.what();
    }
    return "no error";
}

} // namespace pellucid::test
