#include <windows.h>

#include <cstdio>
#include <cstdlib>

#include "mjarm/core/messages/run.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_process_internal.hpp"
#include "mjarm/core/os_program.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {

Result<int> run_program(const std::filesystem::path& program,
                        const std::vector<std::string>& arguments) {
  (void)std::fflush(nullptr);  // what was printed before comes before what it prints
  unsigned long error = 0;
  const Process process = start_process({.program = program,
                                         .arguments = arguments,
                                         .input = GetStdHandle(STD_INPUT_HANDLE),
                                         .output = GetStdHandle(STD_OUTPUT_HANDLE),
                                         .errors = GetStdHandle(STD_ERROR_HANDLE),
                                         .own_group = false},
                                        error);
  if (!process.process) {
    return fail(Errc::system,
                text(msg::run_cannot, utf8(program.wstring()), windows_message(error)));
  }
  while (!process.wait(50)) {
    if (interrupted()) process.kill();
  }
  if (interrupted()) return fail(Errc::system, text(msg::run_interrupted));
  return static_cast<int>(process.exit_code());
}

/// Windows cannot put a program in the place of another: this one waits for it and ends as it does.
Error become_program(const std::filesystem::path& program,
                     const std::vector<std::string>& arguments) {
  const Result<int> code = run_program(program, arguments);
  if (!code) return code.error();
  (void)std::fflush(nullptr);
  std::_Exit(*code);
}

}  // namespace mjarm
