// What libhdf5 has open, closed with this; and what it says where it fails.
#pragma once

#include <string>
#include <utility>

#include <hdf5.h>

namespace pellucid {

class Hdf5Handle {
public:
    Hdf5Handle() = default;
    explicit Hdf5Handle(hid_t id) : m_id(id) {}
    ~Hdf5Handle() {
        if (m_id >= 0) H5Idec_ref(m_id);
    }
    Hdf5Handle(Hdf5Handle&& other) noexcept : m_id(std::exchange(other.m_id, -1)) {}
    Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
        std::swap(m_id, other.m_id);
        return *this;
    }
    hid_t id() const { return m_id; }
    explicit operator bool() const { return m_id >= 0; }

private:
    hid_t m_id = -1;
};

/// Why the last call has failed: what libhdf5 says first of it.
std::string hdf5Problem();

} // namespace pellucid
