#include <windows.h>

#include <array>

#include "mjarm/core/os_process_internal.hpp"
#include "mjarm/core/os_text_internal.hpp"

namespace mjarm {
namespace {

/// As CommandLineToArgvW and the C libraries take it apart again.
void add_quoted(std::string& line, const std::string& word) {
  if (!line.empty()) line += ' ';
  // cmd.exe has rules of its own, and takes only what needs none.
  if (!word.empty() && word.find_first_of(" \t\n\"") == std::string::npos) {
    line += word;
    return;
  }
  line += '"';
  std::size_t backslashes = 0;
  for (const char c : word) {
    if (c == '"') line.append(backslashes + 1, '\\');
    backslashes = c == '\\' ? backslashes + 1 : 0;
    line += c;
  }
  line.append(backslashes, '\\');
  line += '"';
}

std::wstring command_line(const ProcessStart& start) {
  std::string line;
  add_quoted(line, utf8(start.program.wstring()));
  for (const std::string& word : start.arguments) add_quoted(line, word);
  return utf16(line);
}

/// A copy of a handle that another process may have, or the null device.
Handle inheritable(void* handle) {
  SECURITY_ATTRIBUTES shared{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
  HANDLE copy = nullptr;
  const HANDLE self = GetCurrentProcess();
  if (handle != nullptr && handle != INVALID_HANDLE_VALUE &&
      DuplicateHandle(self, handle, self, &copy, 0, TRUE, DUPLICATE_SAME_ACCESS) != FALSE) {
    return Handle(copy);
  }
  copy = CreateFileW(L"NUL", GENERIC_READ | GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE,
                     &shared, OPEN_EXISTING, 0, nullptr);
  return Handle(copy == INVALID_HANDLE_VALUE ? nullptr : copy);
}

/// A job ends its processes when nobody holds it any more.
Handle make_job(std::size_t memory) {
  Handle job(CreateJobObjectW(nullptr, nullptr));
  JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits{};
  limits.BasicLimitInformation.LimitFlags =
      JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE | JOB_OBJECT_LIMIT_DIE_ON_UNHANDLED_EXCEPTION;
  if (memory > 0) {
    limits.BasicLimitInformation.LimitFlags |= JOB_OBJECT_LIMIT_PROCESS_MEMORY;
    limits.ProcessMemoryLimit = memory;
  }
  SetInformationJobObject(job.get(), JobObjectExtendedLimitInformation, &limits, sizeof(limits));
  return job;
}

/// The handles that the new process gets, and no others that happen to be inheritable.
class OnlyThese {
 public:
  explicit OnlyThese(std::array<HANDLE, 3>& handles) {
    SIZE_T size = 0;
    InitializeProcThreadAttributeList(nullptr, 1, 0, &size);
    memory_.resize(size);
    if (InitializeProcThreadAttributeList(list(), 1, 0, &size) == FALSE) memory_.clear();
    if (memory_.empty()) return;
    UpdateProcThreadAttribute(list(), 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, handles.data(),
                              sizeof(handles), nullptr, nullptr);
  }
  ~OnlyThese() {
    if (!memory_.empty()) DeleteProcThreadAttributeList(list());
  }
  OnlyThese(const OnlyThese&) = delete;
  OnlyThese& operator=(const OnlyThese&) = delete;
  [[nodiscard]] LPPROC_THREAD_ATTRIBUTE_LIST list() {
    return memory_.empty() ? nullptr
                           : reinterpret_cast<LPPROC_THREAD_ATTRIBUTE_LIST>(memory_.data());
  }

 private:
  std::vector<char> memory_;
};

}  // namespace

void Handle::close() noexcept {
  if (handle_ != nullptr) CloseHandle(std::exchange(handle_, nullptr));
}

Pipe make_pipe() {
  HANDLE read = nullptr, write = nullptr;
  if (CreatePipe(&read, &write, nullptr, 1 << 16) == FALSE) return {};
  return {Handle(read), Handle(write)};
}

bool Process::wait(unsigned milliseconds) const noexcept {
  return WaitForSingleObject(process.get(), milliseconds) != WAIT_TIMEOUT;
}

unsigned long Process::exit_code() const noexcept {
  DWORD code = 0;
  GetExitCodeProcess(process.get(), &code);
  return code;
}

double Process::cpu_seconds() const noexcept {
  FILETIME created, ended, kernel, user;
  if (GetProcessTimes(process.get(), &created, &ended, &kernel, &user) == FALSE) return 0;
  const auto seconds = [](const FILETIME& time) {
    return 1e-7 * (4294967296.0 * time.dwHighDateTime + time.dwLowDateTime);
  };
  return seconds(kernel) + seconds(user);
}

void Process::kill() const noexcept {
  TerminateProcess(process.get(), 1);
  WaitForSingleObject(process.get(), INFINITE);
}

Process start_process(const ProcessStart& start, unsigned long& error) {
  const std::array<Handle, 3> streams = {inheritable(start.input), inheritable(start.output),
                                         inheritable(start.errors)};
  std::array<HANDLE, 3> handles = {streams[0].get(), streams[1].get(), streams[2].get()};
  OnlyThese only(handles);
  STARTUPINFOEXW info{};
  info.StartupInfo.cb = sizeof(info);
  info.StartupInfo.dwFlags = STARTF_USESTDHANDLES;
  info.StartupInfo.hStdInput = handles[0];
  info.StartupInfo.hStdOutput = handles[1];
  info.StartupInfo.hStdError = handles[2];
  info.lpAttributeList = only.list();
  DWORD how = CREATE_SUSPENDED | EXTENDED_STARTUPINFO_PRESENT;
  if (start.own_group) how |= CREATE_NEW_PROCESS_GROUP;
  std::wstring line = command_line(start);
  PROCESS_INFORMATION made{};
  if (CreateProcessW(nullptr, line.data(), nullptr, nullptr, TRUE, how, nullptr, nullptr,
                     &info.StartupInfo, &made) == FALSE) {
    error = GetLastError();
    return {};
  }
  Process process{Handle(made.hProcess), make_job(start.memory)};
  const Handle thread(made.hThread);
  AssignProcessToJobObject(process.job.get(), process.process.get());
  ResumeThread(thread.get());
  return process;
}

}  // namespace mjarm
