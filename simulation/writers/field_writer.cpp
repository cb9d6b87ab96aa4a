#include "simulation/writers/field_writer.hpp"

namespace snag {

Registry<FieldWriter>& field_writers() {
  static Registry<FieldWriter> writers("format of fields");
  return writers;
}

std::string field_format_meaning() {
  std::string meaning = "Format of the files in fields/, walls/ and rags/.";
  for (const std::string& name : field_writers().names()) meaning += " " + name + ": " + field_writers().make(name, "manual")->meaning();
  return meaning;
}

}  // namespace snag
