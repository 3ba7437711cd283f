#pragma once

#include <mujoco/mujoco.h>

#include "mjarm/model/xml_sources_internal.hpp"

namespace mjarm {

/// Shipped files in the places where MuJoCo looks for those that a scene includes.
class StandIns {
 public:
  StandIns() { mj_defaultVFS(&files_); }
  ~StandIns() { mj_deleteVFS(&files_); }
  StandIns(const StandIns&) = delete;
  StandIns& operator=(const StandIns&) = delete;

  void add(const XmlSources& sources) {
    for (const auto& document : sources.documents()) {
      if (document->stands_for.empty()) continue;
      const std::string& text = document->text;
      any_ = true;
      mj_addBufferVFS(&files_, document->stands_for.c_str(), text.data(),
                      static_cast<int>(text.size()));
    }
  }
  [[nodiscard]] const mjVFS* get() const { return any_ ? &files_ : nullptr; }

 private:
  mjVFS files_;
  bool any_ = false;
};

}  // namespace mjarm
