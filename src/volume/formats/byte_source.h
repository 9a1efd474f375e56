// The bytes of a file one after the other, as they are or decoded.
#pragma once

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <zlib.h>

#include "base/job.h"

namespace pellucid {

/// Bytes in the order of the file. Reads ahead by a fixed amount only, whatever the file holds.
class ByteSource {
public:
    virtual ~ByteSource() = default;
    /// The next `count` bytes, fewer where the data end or are damaged. Throws Cancelled.
    virtual std::size_t read(char* to, std::size_t count) = 0;
    /// Leaves out `count` bytes; false where there are fewer.
    virtual bool skip(std::uint64_t count);
};

/// A file from byte `start` on.
class FileBytes final : public ByteSource {
public:
    FileBytes(const std::string& path, std::uint64_t start, const JobControl& job);
    std::size_t read(char* to, std::size_t count) override;
    bool skip(std::uint64_t count) override;

private:
    std::ifstream m_in;
    const JobControl& m_job;
};

/// The unpacked bytes of members with checksums, one behind the other to the end of a file.
class UnpackedBytes : public ByteSource {
public:
    enum class End {
        None,     ///< there is more
        Whole,    ///< the file ends with the stream, or with zeros behind it
        Followed, ///< something else stands behind it
        CutOff,   ///< within a member
        WrongSum, ///< checksum or length of a member are not those of what it unpacks to
        Damaged   ///< what there is does not unpack
    };

    virtual std::uint64_t decoded() const = 0; ///< bytes that have come out
    /// How many of them lie in members that have ended with the right checksum and length.
    virtual std::uint64_t soundBytes() const = 0;
    /// How the stream ended; None before read() has returned fewer bytes than it was asked for.
    virtual End end() const = 0;
};

/// The unpacked bytes of the deflate stream at byte `start` of a file: gzip, also of several members; with `zlib` it
/// may be a zlib stream. Bytes may be damaged until the member that holds them has ended: see soundBytes().
class InflatedBytes final : public UnpackedBytes {
public:
    InflatedBytes(const std::string& path, std::uint64_t start, bool zlib, const JobControl& job);
    ~InflatedBytes() override;
    InflatedBytes(const InflatedBytes&) = delete;
    InflatedBytes& operator=(const InflatedBytes&) = delete;
    std::size_t read(char* to, std::size_t count) override;
    /// A place in the stream where reading can go on.
    struct Place {
        std::uint64_t decoded = 0; ///< bytes that have come out
        std::uint64_t sound = 0;   ///< soundBytes()
        std::uint64_t packed = 0;  ///< byte of the file that is next
        bool memberEnded = false;
        std::unique_ptr<z_stream, void (*)(z_stream*)> state; ///< about 40 kB
    };
    /// Goes on at `place` of the stream of this file.
    InflatedBytes(const std::string& path, const Place& place, const JobControl& job);
    Place place() const;
    std::uint64_t decoded() const override { return m_decoded; }
    std::uint64_t soundBytes() const override { return m_sound; }
    End end() const override { return m_end; }

private:
    bool fill();
    bool beginMember();
    std::ifstream m_in;
    const JobControl& m_job;
    z_stream m_stream{};
    std::vector<unsigned char> m_packed;
    bool m_memberEnded = false;
    std::uint64_t m_decoded = 0, m_sound = 0, m_filePosition = 0; // the last of m_in, from the beginning of the file
    End m_end = End::None;
};

/// The characters of a file one by one, from byte `start` on.
class FileCharacters {
public:
    FileCharacters(const std::string& path, std::uint64_t start, const JobControl& job) : m_bytes(path, start, job) {}

    /// The next character, which remains the next one; −1 at the end.
    int peek() { return m_at < m_piece.size() || refill() ? static_cast<unsigned char>(m_piece[m_at]) : -1; }
    /// Goes past the character that peek() told.
    void pass() { ++m_at; }
    /// Goes to the next `character`; false where there is none.
    bool goTo(char character);
    /// Goes past `count` characters without looking at them; false where reading fails.
    bool skip(std::uint64_t count);
    std::uint64_t passed() const { return m_before + m_at; } ///< characters, from `start` on

private:
    bool refill();
    FileBytes m_bytes;
    std::string m_piece;
    std::size_t m_at = 0;
    std::uint64_t m_before = 0; // characters before m_piece
};

/// The bytes of hexadecimal digits; blanks and line ends are skipped, anything else ends the data.
class HexBytes final : public ByteSource {
public:
    HexBytes(const std::string& path, std::uint64_t start, const JobControl& job) : m_digits(path, start, job) {}
    std::size_t read(char* to, std::size_t count) override;

private:
    FileCharacters m_digits;
};

/// The words of a text, separated by blanks, line ends or commas, up to its end or to markup ("<").
class TextWords {
public:
    TextWords(const std::string& path, std::uint64_t start, const JobControl& job) : m_text(path, start, job) {}
    /// False at the end of the file. A word longer than any number is cut.
    bool next(std::string& word);

private:
    FileCharacters m_text;
};

} // namespace pellucid
