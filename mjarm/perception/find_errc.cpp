#include "mjarm/perception/find_errc.hpp"

#include "mjarm/core/messages/perception.hpp"

namespace mjarm::perception {

std::string describe(FindErrc code) {
  switch (code) {
    case FindErrc::not_seen:
      return text(msg::perception_not_seen);
    case FindErrc::tag_twice:
      return text(msg::perception_tag_twice);
    case FindErrc::wrong_size:
      return text(msg::perception_tag_wrong_size);
    case FindErrc::no_depth:
      return text(msg::perception_no_depth);
    case FindErrc::disagrees:
      return text(msg::perception_disagrees);
    case FindErrc::occluded:
      return text(msg::perception_occluded);
    case FindErrc::ambiguous:
      return text(msg::perception_ambiguous);
    case FindErrc::touching:
      return text(msg::perception_touching);
  }
  return {};
}

}  // namespace mjarm::perception
