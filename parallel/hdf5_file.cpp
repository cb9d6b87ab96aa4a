#include "parallel/hdf5_file.hpp"

namespace snag::hdf5 {

namespace {

herr_t write(hid_t object, const char* name, hid_t file_type, hid_t memory_type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const htri_t exists = H5Aexists(object, name);
  if (exists < 0) return -1;
  const Handle attribute(exists ? H5Aopen(object, name, H5P_DEFAULT) : H5Acreate2(object, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  return attribute < 0 ? -1 : H5Awrite(attribute, memory_type, value);
}

template <class T>
std::optional<T> read(hid_t object, const char* name, hid_t memory_type) {
  T value{};
  if (H5Aexists(object, name) <= 0) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (attribute < 0 || H5Aread(attribute, memory_type, &value) < 0) return {};
  return value;
}

Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, size);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  return type;
}

herr_t keep_description(unsigned, const H5E_error2_t* entry, void* text) {
  if (entry->desc && *entry->desc) *static_cast<std::string*>(text) = entry->desc;
  return 0;
}

}  // namespace

void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

std::string last_reason() {
  std::string reason = "no reason given";
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_description, &reason);  // from the call down to the cause: the last one stays
  silence();
  return reason;
}

herr_t write_attribute(hid_t object, const char* name, std::int64_t value) {
  return write(object, name, H5T_STD_I64LE, H5T_NATIVE_INT64, &value);
}

herr_t write_attribute(hid_t object, const char* name, double value) {
  return write(object, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, &value);
}

herr_t write_attribute(hid_t object, const char* name, const std::string& value) {
  const Handle type = text_type(value.empty() ? 1 : value.size());
  return write(object, name, type, type, value.c_str());
}

std::optional<std::int64_t> integer_attribute(hid_t object, const char* name) { return read<std::int64_t>(object, name, H5T_NATIVE_INT64); }

std::optional<double> number_attribute(hid_t object, const char* name) { return read<double>(object, name, H5T_NATIVE_DOUBLE); }

std::optional<std::string> text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  std::string value(attribute < 0 ? 0 : H5Aget_storage_size(attribute), '\0');
  if (value.empty() || H5Aread(attribute, text_type(value.size()), value.data()) < 0) return {};
  return std::string(value.c_str());
}

}  // namespace snag::hdf5
