#pragma once
// HDF5 identifiers that close themselves, attributes, and the library's own words about a failure. For .cpp files of this folder only.
#include <hdf5.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace snag::hdf5 {

/// An identifier of the library with the call that closes it.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle() = default;
  Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  ~Handle() { reset(); }
  /// Closes now; negative if that failed.
  herr_t reset() {
    const hid_t id = std::exchange(id_, -1);
    return id < 0 ? 0 : close_(id);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// Why the last call failed, in the words of the library; it no longer prints them itself once this was called or a file was opened here.
std::string last_reason();
/// Stops the library from printing its error stack.
void silence();

/// Attributes of an object; write_ returns a negative number on failure. On a file open on several ranks all write the same value together.
herr_t write_attribute(hid_t object, const char* name, std::int64_t value);
herr_t write_attribute(hid_t object, const char* name, double value);
herr_t write_attribute(hid_t object, const char* name, const std::string& value);
std::optional<std::int64_t> integer_attribute(hid_t object, const char* name);
std::optional<double> number_attribute(hid_t object, const char* name);
std::optional<std::string> text_attribute(hid_t object, const char* name);

}  // namespace snag::hdf5
