// What goes wrong outside our control (files, drivers, arguments), in three parts that users can act on.
#pragma once

#include <stdexcept>
#include <string>

namespace pellucid {

/// What would help, where that is a setting of the program: the command line names its option, the window its control.
enum class Remedy {
    AsSaid,           ///< whatToDo() says it
    AllowMoreMemory,  ///< the limit on memory
    GiveRawLayout,    ///< say how headerless data lies in its file
    CorrectRawLayout, ///< that, or how many bytes to skip
    GiveSpacing,      ///< distances of the voxels
    NoComponent,      ///< ask for no component
    OtherEngine       ///< let the CPU do it
};

/// An error of the outside world: what went wrong, where, and what to do about it. `main` alone (or the window's
/// dialog) catches it. Each part is one line without a full stop; `where` and `whatToDo` may be empty. Control
/// characters, which file names and damaged headers bring along, become blanks.
class Error : public std::runtime_error {
public:
    Error(std::string what, std::string where, std::string whatToDo, Remedy remedy = Remedy::AsSaid)
        : std::runtime_error(oneLine(join(what, where, whatToDo))), m_what(oneLine(std::move(what))),
          m_where(oneLine(std::move(where))), m_whatToDo(oneLine(std::move(whatToDo))), m_remedy(remedy) {}

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
    static std::string oneLine(std::string text) {
        for (char& c : text)
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
        return text;
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
