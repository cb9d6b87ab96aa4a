#include "parallel/standard_output.hpp"

#include <iostream>

#include "base/atomic_file.hpp"
#include "base/terminal.hpp"
#include "parallel/session.hpp"

namespace snag {

namespace {

void print_here(const std::string& text) {
  std::cout << text;
  check_standard_output();
}

}  // namespace

void print(const std::string& text) {
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) == 0) print_here(text);
  });
}

void write_or_print(const std::string& file, const std::function<std::string()>& text) {
  on_all_ranks(MPI_COMM_WORLD, [&] {
    if (rank_of(MPI_COMM_WORLD) != 0) return;
    if (file.empty())
      print_here(text());
    else
      write_atomically(file, text());
  });
}

}  // namespace snag
