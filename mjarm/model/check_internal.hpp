#pragma once

#include <tinyxml2.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mjarm/model/arm.hpp"
#include "mjarm/model/check.hpp"
#include "mjarm/model/complaint_internal.hpp"
#include "mjarm/model/numbers_internal.hpp"

namespace mjarm {

/// Where something stands.
struct Place {
  std::string file;
  int line = 0;
  std::string element;
};

/// One element of a description, with what surrounds it.
struct SourceNode {
  const tinyxml2::XMLElement* element = nullptr;
  const std::string* file = nullptr;
  std::string_view section;  ///< `worldbody`, `asset`, ...: the child of the root around it
  std::string around;        ///< name of the nearest element around it that has one
  std::string body;          ///< name of the body (MJCF) it belongs to
  /// In `default`: the class it sets; elsewhere the class in force (childclass), "main" where none.
  std::string cls = "main";

  [[nodiscard]] std::string_view kind() const { return element->Name(); }
  /// An attribute, empty where it is missing.
  [[nodiscard]] std::string_view attribute(const char* name) const;
};

/// A value and the element that sets it: the one asked for, or a default class.
struct Setting {
  std::string value;
  const SourceNode* node;
};

/// A description as written, included files in their places.
class Description {
 public:
  /// Reads the file and what it includes; what cannot be read is left out.
  explicit Description(const std::filesystem::path& file, bool allow_outside = false);

  [[nodiscard]] bool empty() const { return nodes_.empty(); }
  [[nodiscard]] bool is_urdf() const { return is_urdf_; }
  /// All elements in the order of reading, without the roots and the includes.
  [[nodiscard]] const std::vector<SourceNode>& nodes() const { return nodes_; }

  /// The first element of that section, kind (empty = any) and name; null where there is none.
  [[nodiscard]] const SourceNode* find(std::string_view section, std::string_view kind,
                                       std::string_view name) const;
  /// The attribute of `node`, own or from its default classes.
  [[nodiscard]] std::optional<Setting> setting(const SourceNode& node, const char* attribute) const;

  [[nodiscard]] Place place(const SourceNode& node) const;
  /// The file as a whole: its root element.
  [[nodiscard]] Place root() const;
  /// A body (MJCF) or link (URDF) by its name, the file where it is not found.
  [[nodiscard]] Place body(const std::string& name) const;
  /// The <inertial> of a body or link; the body where it has none of its own.
  [[nodiscard]] Place inertial(const std::string& body) const;
  [[nodiscard]] bool has_inertial(const std::string& body) const;
  /// True where a joint of a body (MJCF) moves it.
  [[nodiscard]] bool has_joint(const std::string& body) const;
  /// A joint by its name.
  [[nodiscard]] Place joint(const std::string& name) const;
  /// An actuator by its name; with `attributes`, the element that sets the first one of them.
  [[nodiscard]] Place actuator(const std::string& name,
                               const std::vector<const char*>& attributes = {}) const;
  /// A geom by its name; its body, `owner`, where it has none.
  /// @param attribute  the place is that of the default class that sets it, where one does.
  [[nodiscard]] Place geom(const std::string& name, const std::string& owner,
                           const char* attribute) const;
  /// The last <option> with one of the attributes; the root where there is none.
  [[nodiscard]] Place option(const char* attribute) const;
  /// The class that a default class stands in; empty for the outermost one.
  [[nodiscard]] std::string parent_class(const std::string& cls) const;

 private:
  struct Surroundings;
  void walk(const tinyxml2::XMLElement& parent, const std::string& file,
            const Surroundings& surroundings);

  XmlSources sources_;
  std::map<std::string, const SourceElement*> roots_;  ///< by file, those not yet walked
  bool is_urdf_ = false;
  std::vector<SourceNode> nodes_;
  std::map<std::string, std::string> parent_class_;
  std::map<std::string, const SourceNode*> inertials_;  ///< by body or link
  std::set<std::string> jointed_;                       ///< bodies with joints
  using Key = std::pair<std::string, std::string>;
  std::map<Key, std::vector<const SourceNode*>> named_;     ///< by section and name
  std::map<Key, std::vector<const SourceNode*>> defaults_;  ///< by class and kind
};

/// What the checks read, and where they put what they find.
struct CheckContext {
  const Description& description;
  const Model* model = nullptr;  ///< null where the file does not load
  const Arm* arm = nullptr;      ///< null where none is found
  const LoadOptions& load;       ///< with which the model was loaded
  std::vector<Finding>& findings;
  GripMend& grip_mend;

  void add(CheckCode code, Grade grade, Place place, std::string what) const {
    findings.push_back({code, grade, std::move(place.file), place.line, std::move(place.element),
                        std::move(what)});
  }
};

// Of the text alone.
void check_names(const CheckContext& context);
void check_unused(const CheckContext& context);
void check_angles(const CheckContext& context);
void check_inertials(const CheckContext& context);
void check_urdf_links(const CheckContext& context);
void check_urdf_joints(const CheckContext& context);
// Of the compiled model.
void check_world(const CheckContext& context);
void check_masses(const CheckContext& context);
// Of the arm.
void check_arm(const CheckContext& context);
void check_actuators(const CheckContext& context);
void check_sag(const CheckContext& context);
void check_home(const CheckContext& context);
void check_grip(const CheckContext& context);

/// Eigenvalues of an inertia [kg m^2].
[[nodiscard]] Eigen::Vector3d principal_moments(const Eigen::Matrix3d& I);

/// `principal` moments of inertia: positive, and no one above the sum of the others.
void check_moments(const CheckContext& context, const Place& place,
                   const Eigen::Vector3d& principal);

}  // namespace mjarm
