#pragma once
// Case files: TOML, read through parameter records. Every number reaches the program in SI; unknown keys are errors that name the nearest
// known one.
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/parameter.hpp"

namespace snag {

struct CaseNode;

/// "case.toml:12: [flow] outer_correctors is now called n_outer_correctors; the old name is read until 1.0". `where` ends in a space.
std::string former_name_note(const std::string& where, const std::string& former, const std::string& present);

/// A table of a case file, present or not. Copies refer to the same table.
class Table {
 public:
  /// True if the file has this table at all.
  bool present() const;
  /// True if a key or sub-table is there, with or without a unit in the key; does not count as reading it.
  bool has(std::string_view key) const;
  /// Sub-table [name], which may be absent: reading an absent table leaves the defaults.
  Table table(const std::string& name) const;
  /// The same for a table that may stand in the file under its former name: then a warning names both. Throws Error(usage) if the file has
  /// both.
  bool has(const Section& section) const;
  Table table(const Section& section) const;
  /// [[name]] or [name], in order of the file; empty if absent.
  std::vector<Table> tables(const std::string& name) const;
  /// Read all parameters into their targets. Throws Error(usage) on a wrong type, unit, range, choice or a missing required key.
  void read(const std::vector<Parameter>& parameters) const;
  /// Name = value pairs of a table with free keys, numbers only, as written.
  std::vector<std::pair<std::string, double>> numbers() const;
  /// What was read of this table and of those in it, as TOML in SI; files by their content.
  std::string resolved() const;
  /// "case.toml:12: [flow]", for messages.
  std::string where() const;

 private:
  friend class CaseFile;
  Table(std::shared_ptr<CaseNode> owner, CaseNode* node) : root_(std::move(owner)), node_(node) {}
  std::shared_ptr<CaseNode> root_;
  CaseNode* node_;
};

class CaseFile {
 public:
  /// Read a file and apply overrides "section.key=value" ("rag.0.radius=\"1 mm\"" for repeated tables). Throws Error(usage, or io if
  /// absent).
  static CaseFile read(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});
  /// The same from text; `name` stands in messages.
  static CaseFile parse(const std::string& text, const std::string& name = "case", const std::vector<std::string>& overrides = {});

  /// Many files from one text, which is parsed once: each is what parse() makes of the text with these overrides.
  class Text {
   public:
    /// Throws Error(usage) where the text is no TOML.
    Text(const std::string& text, const std::string& name);
    CaseFile with(const std::vector<std::string>& overrides) const;

   private:
    std::shared_ptr<const CaseNode> root_;
  };

  Table root() const;
  /// Throws Error(usage) if a key of the file was never read: a misspelt key must not be ignored.
  void reject_unread() const;
  /// The case with all defaults as it was read, as TOML in SI with the unit in the key; reading it gives the same case.
  /// Files are named by their whole path, so that it may be read from any folder.
  std::string resolved() const;
  /// SHA-256 of the values that differ from their defaults, hexadecimal: a new key at its default does not change it, nor does a new name
  /// of a key, a value or a table. Of a file that the case names, the content counts, not the path.
  std::string sha256() const;
  /// The same without what a resumed run may change, as the end of the time.
  std::string resume_sha256() const;
  /// An override "section.key=value", or its key alone, with the names of today where it has former ones; once the case has been read.
  std::string with_present_names(const std::string& override_text) const;
  /// The same with the first names, as tables of runs have it: a new name loses no run.
  std::string with_first_names(const std::string& override_text) const;
  /// A line for each former name that was read, as the warning says it.
  const std::vector<std::string>& former_names() const;
  /// A path of the case file, relative to the folder of the file.
  std::filesystem::path path(const std::string& relative) const;
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  std::shared_ptr<CaseNode> root_;
};

}  // namespace snag
