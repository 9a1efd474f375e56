// What goes wrong outside our control (files, drivers, arguments), in three parts that users can act on.
#pragma once

#include <stdexcept>
#include <string>

#include "base/text.h"

namespace pellucid {

/// What would help, where that is a setting of the program: the command line names its option, the window its control.
enum class Remedy {
    AsSaid,           ///< whatToDo() says it
    AllowMoreMemory,  ///< the limit on memory
    GiveRawLayout,    ///< say how headerless data lies in its file
    CorrectRawLayout, ///< that, or how many bytes to skip
    GiveSpacing,      ///< distances of the voxels
    NoComponent,      ///< ask for no component
    AllowOutside,     ///< let the headers of this opening name files outside their folders
    OtherEngine       ///< let the CPU do it
};

/// An error of the outside world: what went wrong, where, and what to do about it. `main` alone (or the window's
/// dialog) catches it. Each part is one line without a full stop; `where` and `whatToDo` may be empty. What file
/// names and damaged headers bring along is made printable().
class Error : public std::runtime_error {
public:
    Error(std::string what, std::string where, std::string whatToDo, Remedy remedy = Remedy::AsSaid)
        : std::runtime_error(printable(join(what, where, whatToDo))), m_what(printable(what)),
          m_where(printable(where)), m_whatToDo(printable(whatToDo)), m_remedy(remedy) {}

    const std::string& problem() const noexcept { return m_what; }
    const std::string& where() const noexcept { return m_where; }
    const std::string& whatToDo() const noexcept { return m_whatToDo; }
    Remedy remedy() const noexcept { return m_remedy; }
    /// what() is "WHAT, WHERE, WHAT TO DO" on one line.

private:
    static std::string join(const std::string& a, const std::string& b, const std::string& c) {
        std::string line = a;
        if (!b.empty()) line += ", " + b;
        if (!c.empty()) line += ", " + c;
        return line;
    }
    std::string m_what, m_where, m_whatToDo;
    Remedy m_remedy = Remedy::AsSaid;
};

/// A file that cannot be read or written; `where` is its path.
class FileError : public Error {
public:
    using Error::Error;
};

/// Wrong arguments: exit status 2.
class UsageError : public Error {
public:
    using Error::Error;
};

/// Thrown out of a long computation whose JobControl was asked to stop. Not an error: nobody prints it.
struct Cancelled {};

} // namespace pellucid
