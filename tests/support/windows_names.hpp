#pragma once

#include <chrono>
#include <cstdlib>
#include <thread>

// What tests call and Windows has by other names; included in front of every test there.

inline int setenv(const char* name, const char* value, int) { return ::_putenv_s(name, value); }
inline int unsetenv(const char* name) { return ::_putenv_s(name, ""); }
inline void usleep(unsigned microseconds) {
  std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
}
