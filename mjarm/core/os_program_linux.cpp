#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "mjarm/core/messages/run.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_program.hpp"

namespace mjarm {

namespace {

/// As the system takes them; they point into `words`, the name of the program first.
std::vector<char*> argv_of(std::vector<std::string>& words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  return argv;
}

std::vector<std::string> words_of(const std::filesystem::path& program,
                                  const std::vector<std::string>& arguments) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

}  // namespace

Result<int> run_program(const std::filesystem::path& program,
                        const std::vector<std::string>& arguments) {
  std::vector<std::string> words = words_of(program, arguments);
  const std::string name = words.front();
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, name.c_str(), nullptr, nullptr, argv_of(words).data(), environ);
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

Error become_program(const std::filesystem::path& program,
                     const std::vector<std::string>& arguments) {
  std::vector<std::string> words = words_of(program, arguments);
  (void)::execv(words.front().c_str(), argv_of(words).data());
  return {Errc::system, text(msg::run_cannot, words.front(), system_message(errno))};
}

}  // namespace mjarm
