#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// How another program that was fed came to its end.
struct FedProgramEnd {
  int exit_code = 0;       ///< 128 + N where signal N ended it; 0 also where nobody can tell
  std::string complaints;  ///< the end of what it wrote to standard error, 64 KiB at most
};

/// Another program that reads its standard input from us. What it prints is kept away from the
/// user: standard output is dropped, standard error is kept for `finish`. Ctrl-C does not reach it:
/// whoever feeds it decides what becomes of it.
class FedProgram {
 public:
  /// Starts `program` with these arguments.
  /// @param program  path, or a name that is looked for in PATH.
  /// @return not_available where there is no such program, system where it cannot be started.
  [[nodiscard]] static Result<FedProgram> start(const std::filesystem::path& program,
                                                const std::vector<std::string>& arguments);
  /// Ends the program at once where `finish` was not called.
  ~FedProgram();
  FedProgram(FedProgram&&) noexcept;
  FedProgram& operator=(FedProgram&&) noexcept;

  /// Hands over all of `bytes`, waiting where the program is slow.
  /// @return false where it does not read any more, most often as it has ended: `finish` tells why.
  [[nodiscard]] bool feed(std::string_view bytes) noexcept;

  /// Closes its input and waits for its end. Call once, last.
  /// @return an error where the user pressed Ctrl-C meanwhile; the program is ended then.
  [[nodiscard]] Result<FedProgramEnd> finish();

 private:
  struct Impl;
  explicit FedProgram(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Where a program of this name is found in PATH; empty where it is not.
[[nodiscard]] std::filesystem::path find_program(const std::string& name);

}  // namespace mjarm
