#pragma once
// Conditions of a case file, and the errors that mistakes in it end with.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.hpp"
#include "solver/boundaries/boundary.hpp"

namespace snag::test {

inline std::vector<PatchBoundary> conditions(const std::string& toml) { return read_boundaries(CaseFile::parse(toml).root()); }

/// The message of the Error(usage) that a piece of work throws.
template <class Work>
std::string usage_error(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::usage);
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return "";
}

inline bool mentions(const std::string& message, const std::string& word) { return message.find(word) != std::string::npos; }

}  // namespace snag::test
