// An immutable part of a session, shared by all copies of it until one of them changes it.
#pragma once

#include <memory>
#include <utility>

namespace pellucid {

/// A value that is cheap to copy. Equal parts need not be the same, but the same part is equal without looking: a
/// session of which one part has changed is compared in the time of that part.
template <class T>
class Part {
public:
    Part() : m_value(empty()) {}
    Part(T value) : m_value(std::make_shared<const T>(std::move(value))) {} // NOLINT: a value is a part

    const T& operator*() const noexcept { return *m_value; }
    const T* operator->() const noexcept { return m_value.get(); }
    const T& get() const noexcept { return *m_value; }

    /// Replaces the value by what `change(T&)` makes of a copy. A change that changes nothing keeps the part the same.
    template <class Change>
    void edit(const Change& change) {
        T copy = *m_value;
        change(copy);
        set(std::move(copy));
    }
    void set(T value) {
        if (!(value == *m_value)) m_value = std::make_shared<const T>(std::move(value));
    }

    /// Never null; the same as long as the part is the same.
    const std::shared_ptr<const T>& shared() const noexcept { return m_value; }

    bool isSame(const Part& other) const noexcept { return m_value == other.m_value; }
    bool operator==(const Part& other) const { return isSame(other) || *m_value == *other.m_value; }

private:
    static const std::shared_ptr<const T>& empty() {
        static const auto value = std::make_shared<const T>();
        return value;
    }
    std::shared_ptr<const T> m_value; // never null
};

} // namespace pellucid
