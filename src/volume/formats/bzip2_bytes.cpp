#include "volume/formats/bzip2_bytes.h"

#include <algorithm>
#include <new>

#include <bzlib.h>

namespace pellucid {

struct Bunzipped::Stream : bz_stream {
    Stream() : bz_stream{} {
        if (BZ2_bzDecompressInit(this, 0, 0) != BZ_OK) throw std::bad_alloc();
    }
    ~Stream() { BZ2_bzDecompressEnd(this); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
};

Bunzipped::Bunzipped(const std::string& path, std::uint64_t start, const JobControl& job)
    : m_in(path, std::ios::binary), m_job(job), m_stream(std::make_unique<Stream>()), m_packed(1u << 18) {
    m_in.seekg(static_cast<std::streamoff>(start));
}

Bunzipped::~Bunzipped() = default;

/// More of the file; false at its end.
bool Bunzipped::fill() {
    m_job.throwIfStopped();
    m_in.read(m_packed.data(), static_cast<std::streamsize>(m_packed.size()));
    m_stream->next_in = m_packed.data();
    m_stream->avail_in = static_cast<unsigned>(m_in.gcount());
    return m_stream->avail_in > 0;
}

/// Behind a stream: whether there is another one. Otherwise m_end says what there is.
bool Bunzipped::beginNext() {
    bz_stream& stream = *m_stream;
    while (stream.avail_in > 0 && *stream.next_in == 0) { // padding
        ++stream.next_in;
        if (--stream.avail_in == 0) fill();
    }
    if (stream.avail_in == 0 || *stream.next_in != 'B') {
        m_end = stream.avail_in == 0 ? End::Whole : End::Followed;
        return false;
    }
    auto next = std::make_unique<Stream>();
    next->next_in = stream.next_in;
    next->avail_in = stream.avail_in;
    m_stream = std::move(next);
    m_streamEnded = false;
    return true;
}

std::size_t Bunzipped::read(char* to, std::size_t count) {
    std::size_t done = 0;
    while (done < count && m_end == End::None) {
        if (m_stream->avail_in == 0 && !fill()) {
            m_end = m_streamEnded ? End::Whole : End::CutOff;
            break;
        }
        if (m_streamEnded && !beginNext()) break;
        const std::size_t piece = std::min<std::size_t>(count - done, 1u << 30);
        m_stream->next_out = to + done;
        m_stream->avail_out = static_cast<unsigned>(piece);
        const int status = BZ2_bzDecompress(m_stream.get());
        if (status == BZ_MEM_ERROR) throw std::bad_alloc();
        done += piece - m_stream->avail_out;
        m_decoded += piece - m_stream->avail_out;
        m_streamEnded = status == BZ_STREAM_END;
        if (m_streamEnded) m_sound = m_decoded; // its sum and those of its blocks are right
        if (status != BZ_OK && status != BZ_STREAM_END) m_end = End::Damaged;
    }
    return done;
}

} // namespace pellucid
