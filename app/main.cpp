#include "app/command_line.hpp"
#include "base/log.hpp"
#include "parallel/session.hpp"

int main(int argc, char** argv) {
  const snag::Session session(argc, argv);
  snag::log::start(session.rank());
  return snag::run_command_line(argc, argv, session);
}
