#include <windows.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "mjarm/core/messages/run.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_child_input.hpp"
#include "mjarm/core/os_process_internal.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {
namespace {

/// A file that vanishes with its last handle.
Handle open_temporary() {
  const std::wstring folder = temp_directory().wstring();
  wchar_t name[MAX_PATH + 1] = L"";
  if (GetTempFileNameW(folder.c_str(), L"mja", 0, static_cast<wchar_t*>(name)) == 0)
    return Handle();
  const HANDLE file = CreateFileW(static_cast<wchar_t*>(name), GENERIC_READ | GENERIC_WRITE,
                                  FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, nullptr,
                                  CREATE_ALWAYS, FILE_FLAG_DELETE_ON_CLOSE, nullptr);
  return Handle(file == INVALID_HANDLE_VALUE ? nullptr : file);
}

/// The end of what a file holds.
std::string end_of(const Handle& file) {
  constexpr LONGLONG kMax = 64 << 10;
  LARGE_INTEGER size{}, from{};
  if (GetFileSizeEx(file.get(), &size) == FALSE || size.QuadPart <= 0) return {};
  std::string words(static_cast<std::size_t>(std::min(size.QuadPart, kMax)), '\0');
  from.QuadPart = size.QuadPart - static_cast<LONGLONG>(words.size());
  SetFilePointerEx(file.get(), from, nullptr, FILE_BEGIN);
  DWORD count = 0;
  ReadFile(file.get(), words.data(), static_cast<DWORD>(words.size()), &count, nullptr);
  words.resize(count);
  return words;
}

}  // namespace

struct FedProgram::Impl {
  ~Impl() {
    if (process.process) process.kill();
  }
  Process process;
  Handle input;
  Handle complaints;
};

Result<FedProgram> FedProgram::start(const std::filesystem::path& program,
                                     const std::vector<std::string>& arguments) {
  const auto cannot = [&program](unsigned long error) {
    const bool missing = error == ERROR_FILE_NOT_FOUND || error == ERROR_PATH_NOT_FOUND;
    return fail(missing ? Errc::not_available : Errc::system,
                text(msg::run_cannot, utf8(program.wstring()), windows_message(error)));
  };
  auto impl = std::make_unique<Impl>();
  Pipe pipe = make_pipe();
  // A file and not a pipe: it takes all there is without anybody reading.
  impl->complaints = open_temporary();
  if (!pipe.write || !impl->complaints) return cannot(GetLastError());
  unsigned long error = 0;
  impl->process = start_process({.program = program,
                                 .arguments = arguments,
                                 .input = pipe.read.get(),
                                 .errors = impl->complaints.get()},
                                error);
  if (!impl->process.process) return cannot(error);
  impl->input = std::move(pipe.write);
  return FedProgram(std::move(impl));
}

FedProgram::FedProgram(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FedProgram::~FedProgram() = default;
FedProgram::FedProgram(FedProgram&&) noexcept = default;
FedProgram& FedProgram::operator=(FedProgram&&) noexcept = default;

bool FedProgram::feed(std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    const auto piece = static_cast<DWORD>(std::min<std::size_t>(bytes.size(), 1 << 20));
    DWORD count = 0;
    if (WriteFile(impl_->input.get(), bytes.data(), piece, &count, nullptr) == FALSE) return false;
    bytes.remove_prefix(count);
  }
  return true;
}

Result<FedProgramEnd> FedProgram::finish() {
  impl_->input.close();
  while (!impl_->process.wait(2)) {
    if (interrupted()) {
      impl_.reset();
      return fail(Errc::system, text(msg::run_interrupted));
    }
  }
  return FedProgramEnd{static_cast<int>(impl_->process.exit_code()), end_of(impl_->complaints)};
}

std::filesystem::path find_program(const std::string& name) {
  std::istringstream folders(environment("PATH").value_or(""));
  for (std::string folder; std::getline(folders, folder, ';');) {
    for (const char* const ending : {"", ".exe"}) {
      const std::filesystem::path file =
          std::filesystem::path(utf16(folder)) / utf16(name + ending);
      std::error_code ignored;
      if (file.has_extension() && std::filesystem::is_regular_file(file, ignored)) return file;
    }
  }
  return {};
}

}  // namespace mjarm
