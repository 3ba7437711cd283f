// What a URDF may not say: for each refusal the whole line that a user reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "mjarm/core/language_scope.hpp"
#include "mjarm/model/model.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::StartsWith;

/// Two links, and what follows from line 4 on.
std::string two_links_and(const std::string& inside) {
  return "<robot name=\"r\">\n<link name=\"base\"/>\n<link name=\"arm\"/>\n" + inside +
         "\n</robot>";
}

/// The joint between them on line 4, its parent on 5, its child on 6 and `inside` from 7 on.
std::string joint_of(const std::string& type, const std::string& inside) {
  return two_links_and("<joint name=\"j\" type=\"" + type +
                       "\">\n<parent link=\"base\"/>\n<child link=\"arm\"/>\n" + inside +
                       "\n</joint>");
}

/// The link "base" with `inside` from line 3 on, and a joint to another.
std::string link_of(const std::string& inside) {
  return "<robot name=\"r\">\n<link name=\"base\">\n" + inside +
         "\n</link>\n<link name=\"arm\"/>\n<joint name=\"j\" type=\"fixed\"><parent "
         "link=\"base\"/><child link=\"arm\"/></joint></robot>";
}

struct RefusedUrdf {
  std::string content;
  std::string line;  ///< of the message, behind the path of the file
};

void expect_refused(const std::vector<RefusedUrdf>& cases) {
  const support::TempFolder folder;
  for (const RefusedUrdf& bad : cases) {
    const auto file = folder.write("机器人.urdf", bad.content);
    const Result<Model> model = Model::load(file);
    ASSERT_FALSE(model) << bad.content;
    EXPECT_EQ(model.error().code, Errc::bad_input);
    EXPECT_EQ(model.error().what, file.string() + bad.line);
    const LanguageScope scope(Language::chinese);
    const Result<Model> again = Model::load(file);
    ASSERT_FALSE(again);
    EXPECT_NE(again.error().what, model.error().what);
    const std::size_t place = bad.line.find(':', 1);  // the number of the line stays
    EXPECT_THAT(again.error().what, StartsWith(file.string() + bad.line.substr(0, place)));
  }
}

TEST(BadUrdf, NamesAreThereAndDiffer) {
  expect_refused(
      {{two_links_and("<link name=\"\"/>"), ":4: <link \"\">: attribute \"name\" is missing"},
       {two_links_and("<joint type=\"fixed\"/>"),
        ":4: <joint> of \"r\": attribute \"name\" is missing"},
       {two_links_and("<link name=\"c\"/>\n"
                      "<joint name=\"j\" type=\"fixed\"><parent link=\"base\"/><child "
                      "link=\"arm\"/></joint>\n"
                      "<joint name=\"j\" type=\"fixed\"><parent link=\"arm\"/><child "
                      "link=\"c\"/></joint>"),
        ":6: <joint \"j\">: the name \"j\" is used twice"}});
}

TEST(BadUrdf, JointsHaveTwoEndsThatAreLinks) {
  expect_refused(
      {{two_links_and("<joint name=\"j\" type=\"fixed\"><child link=\"arm\"/></joint>"),
        ":4: <joint \"j\">: element <parent> is missing inside"},
       {two_links_and("<joint name=\"j\" type=\"fixed\"><parent link=\"base\"/></joint>"),
        ":4: <joint \"j\">: element <child> is missing inside"},
       {two_links_and("<joint name=\"j\" type=\"fixed\">\n<parent/><child link=\"arm\"/></joint>"),
        ":5: <parent> of \"j\": attribute \"link\" is missing"},
       {two_links_and("<joint name=\"j\" type=\"fixed\"><parent link=\"base\"/>\n"
                      "<child link=\"rover\"/></joint>"),
        ":5: <child> of \"j\": there is no link \"rover\""},
       {two_links_and("<joint name=\"j\" type=\"fixed\"><parent link=\"base\"/>\n"
                      "<child link=\"Arm\"/></joint>"),
        ":5: <child> of \"j\": there is no link \"Arm\" (did you mean \"arm\"?)"},
       {joint_of("helical", ""),
        ":4: <joint \"j\">: unknown joint type \"helical\"; expected revolute, continuous, "
        "prismatic, fixed, floating, planar or spherical"}});
}

TEST(BadUrdf, NumbersAreAsManyAsTheirAttributeNeeds) {
  const std::string geometry = "<geometry><sphere radius=\"1\"/></geometry>";
  expect_refused({{joint_of("fixed", "<origin rpy=\"0 0\"/>"),
                   ":7: <origin> of \"j\": rpy=\"0 0\" should be 3 finite number(s)"},
                  {joint_of("fixed", "<origin xyz=\"0 0 0 0\"/>"),
                   ":7: <origin> of \"j\": xyz=\"0 0 0 0\" should be 3 finite number(s)"},
                  {joint_of("fixed", "<origin xyz=\"1,2,3\"/>"),
                   ":7: <origin> of \"j\": xyz=\"1,2,3\" should be 3 finite number(s)"},
                  {joint_of("continuous", "<axis xyz=\"z\"/>"),
                   ":7: <axis> of \"j\": xyz=\"z\" should be 3 finite number(s)"},
                  {joint_of("revolute", "<limit lower=\"-1 1\"/>"),
                   ":7: <limit> of \"j\": lower=\"-1 1\" should be 1 finite number(s)"},
                  {link_of("<inertial><mass value=\"heavy\"/></inertial>"),
                   ":3: <mass> of \"base\": value=\"heavy\" should be 1 finite number(s)"},
                  {link_of("<inertial><mass value=\"1\"/>\n<inertia ixx=\"1 2\"/></inertial>"),
                   ":4: <inertia> of \"base\": ixx=\"1 2\" should be 1 finite number(s)"},
                  {link_of("<visual>\n<origin xyz=\"\"/>" + geometry + "</visual>"),
                   ":4: <origin> of \"base\": xyz=\"\" should be 3 finite number(s)"},
                  {link_of("<collision>\n<origin rpy=\"1 x 3\"/>" + geometry + "</collision>"),
                   ":4: <origin> of \"base\": rpy=\"1 x 3\" should be 3 finite number(s)"}});
}

TEST(BadUrdf, MassesShapesAndLimitsAreComplete) {
  expect_refused(
      {{link_of("<inertial/>"), ":3: <inertial> of \"base\": element <mass> is missing inside"},
       {link_of("<inertial>\n<mass/></inertial>"),
        ":4: <mass> of \"base\": attribute \"value\" is missing"},
       {link_of("\n<collision><origin/></collision>"),
        ":4: <collision> of \"base\": element <geometry> is missing inside"},
       {link_of("<visual name=\"v\"><geometry>\n<mesh/></geometry></visual>"),
        ":4: <mesh> of \"v\": attribute \"filename\" is missing"},
       {joint_of("prismatic", ""), ":4: <joint \"j\">: element <limit> is missing inside"},
       {joint_of("prismatic", "<limit lower=\"0.5\" upper=\"0.25\"/>"),
        ":7: <limit> of \"j\": the lower limit 0.5 is above the upper limit 0.25"},
       {joint_of("revolute", "<limit lower=\"0\" upper=\"1\" effort=\"-1\"/>"),
        ":7: <limit> of \"j\": \"effort\" must not be negative"},
       {joint_of("planar", "<axis xyz=\"0 0 0\"/>"),
        ":7: <axis> of \"j\": the axis has no length"}});
}

TEST(BadUrdf, SlipsOfThePenAreToldWithWhatWasMeant) {
  expect_refused(
      {{two_links_and("<joint name=\"j\" type=\"fixed\">\n<parent lnk=\"base\"/>"
                      "<child link=\"arm\"/></joint>"),
        ":5: <parent> of \"j\": unknown attribute \"lnk\" (did you mean \"link\"?)"},
       {joint_of("revolute", "<limits lower=\"0\" upper=\"1\"/>"),
        ":7: <limits> of \"j\": unknown element <limits> (did you mean \"limit\"?)"},
       {joint_of("revolute", "<limit lower=\"0\" uper=\"1\"/>"),
        ":7: <limit> of \"j\": unknown attribute \"uper\" (did you mean \"upper\"?)"},
       {link_of("<inertial><mass valeu=\"1\"/></inertial>"),
        ":3: <mass> of \"base\": unknown attribute \"valeu\" (did you mean \"value\"?)"}});
}

TEST(BadUrdf, LongNamesAreShownShort) {
  const std::string name(300, 'x');
  const support::TempFolder folder;
  const auto file =
      folder.write("a.urdf", two_links_and("<joint name=\"" + name + "\" type=\"fixed\"/>"));
  const Result<Model> model = Model::load(file);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().what, file.string() + ":4: <joint \"" + name.substr(0, 80) +
                                    "...\">: element <parent> is missing inside");
}

TEST(BadUrdf, WhatOtherReadersTakeIsTaken) {
  const support::TempFolder folder;
  const std::vector<std::string> good = {
      joint_of("fixed", "<axis xyz=\"0 0 0\"/>"),
      joint_of("continuous", "<limit lower=\"1\" upper=\"-1\" effort=\"1\" velocity=\"1\"/>"),
      joint_of("continuous", "<origin xyz=\"+1\t2\n 3\" rpy=\"1e-3 -0 .5\"/>"),
      joint_of("continuous", "<drake:thing value=\"?\"/><somebodys_extension/>"),
      two_links_and("<gazebo><anything><goes inside=\"here\"/></anything></gazebo>"
                    "<transmission name=\"t\"/><joint name=\"j\" type=\"continuous\"><parent "
                    "link=\"base\"/><child link=\"arm\"/></joint>")};
  for (const std::string& text : good) {
    std::string crlf;
    for (const char c : "<?xml version=\"1.0\"?>\n" + text)
      crlf += c == '\n' ? "\r\n" : std::string(1, c);
    for (const std::string& content : {text, crlf}) {
      const Result<Model> model = Model::load(folder.write("a.urdf", content));
      EXPECT_TRUE(model) << content << '\n' << (model ? "" : model.error().what);
    }
  }
}

TEST(BadMjcf, WhatMujocoSaysIsSaidInTheUsersWords) {
  const support::TempFolder folder;
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"<worldbody><geom size=\"1\" pos=\"1 2\"/></worldbody>",
       ":3: <geom>: \"pos\" holds fewer numbers than it needs"},
      {"<worldbody><geom size=\"1\" contype=\"99999999999\"/></worldbody>",
       ":3: <geom>: \"contype\" holds a number that is too large"},
      {"<worldbody><geom size=\"1\" margin=\"wide\"/></worldbody>",
       ":3: <geom>: \"margin\" holds something that is not a number"},
      {"<sensor><user dim=\"1\" objtype=\"body\" objname=\"k\"/></sensor>",
       ":3: there is nothing named \"k\""},
      {"<equality><joint joint1=\"k\"/></equality>", ":3: there is nothing named \"k\""},
      {"<contact><exclude body1=\"link\" body2=\"lnik\"/></contact>",
       ":3: there is no body \"lnik\" (did you mean \"link\"?)"},
      {"<option><flag gravity=\"maybe\"/></option>",
       ":3: <flag>: \"maybe\" is none of the words that may stand here"}};
  for (const auto& [part, line] : cases) {
    const auto file = folder.write(
        "a.xml", std::string("<mujoco><worldbody><body name=\"link\"><joint/>") +
                     "<geom size=\".1\"/></body>\n</worldbody>\n" + part + "</mujoco>");
    const Result<Model> model = Model::load(file);
    ASSERT_FALSE(model) << part;
    EXPECT_EQ(model.error().what, file.string() + line);
    // Compiled in this process it is refused with the same words.
    EXPECT_EQ(Model::load(file, {.trusted = true}).error().what, model.error().what);
  }
}

}  // namespace
}  // namespace mjarm
