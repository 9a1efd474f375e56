// What fuzz targets share. A target hands its input to the functions by which the program reads such input; an Error is
// the accepted answer. Everything else ends the process, and libFuzzer keeps the input: any other exception, a report
// of a sanitizer, a promise that is not kept.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include "base/error.h"
#include "support/temp_folder.h"

namespace pellucid::fuzz {

/// Ends the process unless `holds`; `promise` says what should.
inline void require(bool holds, const char* promise) {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

/// Whether `use()` came to its end. An Error has to say something.
template <class Use>
bool succeeds(const Use& use) {
    try {
        use();
        return true;
    } catch (const Error& e) {
        require(!e.problem().empty(), "an error says what is wrong");
        return false;
    }
}

inline std::string textOf(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Inputs as files, in a folder of this process in $TMPDIR, which scripts/fuzz.sh makes a folder in memory.
class InputFolder {
public:
    /// A file that stays, for inputs that name it.
    void keep(const std::string& name, const std::string& bytes) const { m_folder.write(name, bytes); }

    /// Calls use(path) with the input as a file. Each has a name of its own: readers remember files by name, size and
    /// time, and two inputs may follow each other faster than the clock of files ticks.
    template <class Use>
    void with(const std::uint8_t* data, std::size_t size, const std::string& suffix, const Use& use) const {
        const std::string path = m_folder.write(std::to_string(++m_count) + suffix, textOf(data, size));
        use(path);
        std::filesystem::remove(path);
    }
    std::string path(const std::string& name) const { return m_folder.path(name); }

private:
    test::TempFolder m_folder;
    mutable std::uint64_t m_count = 0;
};

} // namespace pellucid::fuzz
