// Files that a header names outside its own folder: a file from somewhere must not make the program read any file it
// likes.
#pragma once

#include <string>

namespace pellucid {

/// From now on headers may name files anywhere: the user trusts what is opened.
void allowOutsideFiles();
/// The same for this header alone.
void allowOutsideFiles(const std::string& header);

/// Throws FileError (Remedy::AllowOutside) where `named`, as the file `header` has it, is an absolute path or leaves
/// the header's folder, unless that is allowed.
void requireInside(const std::string& header, const std::string& named);

} // namespace pellucid
