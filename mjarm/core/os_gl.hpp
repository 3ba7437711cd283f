#pragma once

#include <memory>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// OpenGL without a window that is seen, as Windows gives it: by a hidden window. On Windows alone.
/// Belongs to the thread that has made it.
class HiddenGl {
 public:
  /// Makes a context and makes it current.
  [[nodiscard]] static Result<HiddenGl> create();
  ~HiddenGl();
  HiddenGl(HiddenGl&&) noexcept;
  HiddenGl& operator=(HiddenGl&&) noexcept;

  [[nodiscard]] Result<void> make_current();
  /// Leaves the calling thread without a context, where it has this one.
  void release() noexcept;
  /// Address of an OpenGL function, or null.
  [[nodiscard]] void* function(const char* name) const;

 private:
  struct Impl;
  explicit HiddenGl(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm
