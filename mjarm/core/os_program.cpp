#include "mjarm/core/os_program.hpp"

#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "mjarm/core/messages/run.hpp"
#include "mjarm/core/os.hpp"

namespace mjarm {

Result<int> run_program(const std::filesystem::path& program,
                        const std::vector<std::string>& arguments) {
  std::string name = program.string();
  std::vector<std::string> words = arguments;
  std::vector<char*> argv{name.data()};
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, name.c_str(), nullptr, nullptr, argv.data(), environ);
  if (error != 0) {
    return fail(Errc::system, text(msg::run_cannot, name, system_message(error)));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      return fail(Errc::system, text(msg::run_cannot, name, system_message(errno)));
    }
    if (interrupted()) ::kill(child, SIGTERM);
  }
  if (interrupted()) return fail(Errc::system, text(msg::run_interrupted));
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace mjarm
