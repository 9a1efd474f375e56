#include "volume/formats/byte_source.h"

#include <algorithm>
#include <cctype>
#include <limits>
#include <new>
#include <string_view>

namespace pellucid {

namespace {

constexpr std::size_t kPiece = 1u << 18;

/// Whether inflate() failed at a sum or length behind data that it could unpack; zlib tells by its message alone.
bool failsItsSum(const z_stream& stream) {
    const std::string_view message = stream.msg == nullptr ? "" : stream.msg;
    return message == "incorrect data check" || message == "incorrect length check";
}

int hexDigit(int c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

} // namespace

bool ByteSource::skip(std::uint64_t count) {
    std::vector<char> dropped(static_cast<std::size_t>(std::min<std::uint64_t>(count, kPiece)));
    while (count > 0) {
        const auto piece = static_cast<std::size_t>(std::min<std::uint64_t>(count, dropped.size()));
        if (read(dropped.data(), piece) < piece) return false;
        count -= piece;
    }
    return true;
}

FileBytes::FileBytes(const std::string& path, std::uint64_t start, const JobControl& job)
    : m_in(path, std::ios::binary), m_job(job) {
    skip(start);
}

std::size_t FileBytes::read(char* to, std::size_t count) {
    constexpr std::size_t kMostAtOnce = 16u << 20; // between two looks at whether to stop
    std::size_t done = 0;
    while (done < count && m_in) {
        m_job.throwIfStopped();
        m_in.read(to + done, static_cast<std::streamsize>(std::min(count - done, kMostAtOnce)));
        done += static_cast<std::size_t>(m_in.gcount());
    }
    return done;
}

bool FileBytes::skip(std::uint64_t count) {
    // What is near is in the buffer already, or as quick to read as to pass over: seeking empties the buffer.
    constexpr std::uint64_t kNear = 8192;
    if (count <= kNear)
        m_in.ignore(static_cast<std::streamsize>(count));
    else if (count > static_cast<std::uint64_t>(std::numeric_limits<std::streamoff>::max()))
        m_in.setstate(std::ios::failbit);
    else
        m_in.seekg(static_cast<std::streamoff>(count), std::ios::cur);
    return static_cast<bool>(m_in);
}

InflatedBytes::InflatedBytes(const std::string& path, std::uint64_t start, bool zlib, const JobControl& job)
    : m_in(path, std::ios::binary), m_job(job), m_packed(kPiece), m_filePosition(start) {
    m_in.seekg(static_cast<std::streamoff>(start));
    if (inflateInit2(&m_stream, zlib ? MAX_WBITS + 32 : MAX_WBITS + 16) != Z_OK) throw std::bad_alloc();
}

InflatedBytes::InflatedBytes(const std::string& path, const Place& place, const JobControl& job)
    : m_in(path, std::ios::binary), m_job(job), m_packed(kPiece), m_memberEnded(place.memberEnded),
      m_decoded(place.decoded), m_sound(place.sound), m_filePosition(place.packed) {
    m_in.seekg(static_cast<std::streamoff>(place.packed));
    if (inflateCopy(&m_stream, place.state.get()) != Z_OK) throw std::bad_alloc();
    m_stream.avail_in = 0;
}

InflatedBytes::Place InflatedBytes::place() const {
    const auto drop = [](z_stream* state) {
        inflateEnd(state);
        delete state;
    };
    Place place{m_decoded, m_sound, m_filePosition - m_stream.avail_in, m_memberEnded, {new z_stream{}, drop}};
    // zlib copies from a state that it does not call const, and leaves it alone.
    if (inflateCopy(place.state.get(), const_cast<z_stream*>(&m_stream)) != Z_OK) throw std::bad_alloc();
    return place;
}

InflatedBytes::~InflatedBytes() { inflateEnd(&m_stream); }

/// More of the file; false at its end.
bool InflatedBytes::fill() {
    m_job.throwIfStopped();
    m_in.read(reinterpret_cast<char*>(m_packed.data()), static_cast<std::streamsize>(m_packed.size()));
    m_stream.next_in = m_packed.data();
    m_stream.avail_in = static_cast<uInt>(m_in.gcount());
    m_filePosition += m_stream.avail_in;
    return m_stream.avail_in > 0;
}

/// Behind a member: whether there is another one. Otherwise m_end says what there is.
bool InflatedBytes::beginMember() {
    constexpr Bytef kGzip = 0x1f; // the first byte of a member
    if (*m_stream.next_in == kGzip && inflateReset(&m_stream) == Z_OK) {
        m_memberEnded = false;
        return true;
    }
    while (m_stream.avail_in > 0 && *m_stream.next_in == 0) { // padding, as tapes and some writers have it
        ++m_stream.next_in;
        if (--m_stream.avail_in == 0) fill();
    }
    m_end = m_stream.avail_in == 0 ? End::Whole : End::Followed;
    return false;
}

std::size_t InflatedBytes::read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count && m_end == End::None) {
        if (m_stream.avail_in == 0 && !fill()) {
            m_end = m_memberEnded ? End::Whole : End::CutOff;
            break;
        }
        if (m_memberEnded && !beginMember()) break;
        const std::size_t piece = std::min<std::size_t>(count - done, 1u << 30);
        m_stream.next_out = reinterpret_cast<Bytef*>(to + done);
        m_stream.avail_out = static_cast<uInt>(piece);
        const int status = inflate(&m_stream, Z_NO_FLUSH);
        if (status == Z_MEM_ERROR) throw std::bad_alloc(); // its window is made when it is needed
        done += piece - m_stream.avail_out;
        m_decoded += piece - m_stream.avail_out;
        m_memberEnded = status == Z_STREAM_END;
        if (m_memberEnded) m_sound = m_decoded;
        if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
            m_end = failsItsSum(m_stream) ? End::WrongSum : End::Damaged;
    }
    return done;
}

bool FileCharacters::refill() {
    m_before += m_piece.size();
    m_piece.resize(kPiece);
    m_piece.resize(m_bytes.read(m_piece.data(), m_piece.size()));
    m_at = 0;
    return !m_piece.empty();
}

bool FileCharacters::goTo(char character) {
    while (peek() >= 0) {
        m_at = std::min(m_piece.find(character, m_at), m_piece.size());
        if (m_at < m_piece.size()) return true;
    }
    return false;
}

bool FileCharacters::skip(std::uint64_t count) {
    const std::uint64_t left = m_piece.size() - m_at;
    if (count <= left) {
        m_at += static_cast<std::size_t>(count);
        return true;
    }
    m_before += m_piece.size() + (count - left);
    m_piece.clear();
    m_at = 0;
    return m_bytes.skip(count - left);
}

std::size_t HexBytes::read(char* to, std::size_t count) {
    for (std::size_t done = 0; done < count; ++done) {
        int byte = 0;
        for (int digits = 0; digits < 2;) {
            const int c = m_digits.peek(), digit = hexDigit(c);
            if (digit < 0 && std::isspace(c) == 0) return done;
            m_digits.pass();
            if (digit < 0) continue;
            byte = byte * 16 + digit;
            ++digits;
        }
        to[done] = static_cast<char>(static_cast<unsigned char>(byte));
    }
    return count;
}

bool TextWords::next(std::string& word) {
    constexpr std::size_t kMostCharacters = 400;
    word.clear();
    for (int c = m_text.peek(); c >= 0 && c != '<'; c = m_text.peek()) { // "<" remains: so does the end
        m_text.pass();
        const bool separates = c == ',' || std::isspace(c) != 0;
        if (separates && !word.empty()) return true;
        if (!separates && word.size() <= kMostCharacters) word += static_cast<char>(c);
    }
    return !word.empty();
}

} // namespace pellucid
