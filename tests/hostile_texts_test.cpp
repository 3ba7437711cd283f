// Hostile files: what is no text, no XML, or XML that eats its reader.
#include "tests/hostile_files.hpp"

namespace mjarm::hostile {
namespace {

std::string every_byte() {
  std::string bytes;
  for (int i = 0; i < 4096; ++i) bytes += static_cast<char>(i);
  return bytes;
}

/// Plain ASCII as UTF-16, its low bytes first (or last), with or without a mark.
std::string utf16(const std::string& words, bool low_first, bool mark) {
  std::string bytes = !mark ? "" : low_first ? "\xff\xfe" : "\xfe\xff";
  for (const char c : words) {
    if (low_first) bytes += c;
    bytes += '\0';
    if (!low_first) bytes += c;
  }
  return bytes;
}

std::string nested(const std::string& element, std::size_t depth) {
  return "<mujoco><worldbody>" + repeat("<" + element + ">", depth) +
         repeat("</" + element + ">", depth) + "</worldbody></mujoco>";
}

}  // namespace

std::string mjcf(const std::string& inside, const std::string& before) {
  return "<mujoco>\n" + before + "<worldbody>\n" + inside + "\n</worldbody></mujoco>";
}

std::string with_asset(const std::string& asset) {
  return mjcf("<geom size=\"1\"/>", "<asset>" + asset + "</asset>");
}

std::string repeat(const std::string& words, std::size_t times) {
  std::string all;
  all.reserve(words.size() * times);
  for (std::size_t i = 0; i < times; ++i) all += words;
  return all;
}

std::vector<HostileFile> hostile_texts() {
  const std::string good = mjcf("<geom size=\"1\"/>");
  return {
      {"Empty", "a.xml", "", {"a.xml", "empty"}},
      {"Blank", "a.xml", " \n\t \n", {"a.xml", "empty"}},
      {"ByteOrderMarkAlone", "a.xml", "\xef\xbb\xbf", {"a.xml", "empty"}},
      {"EveryByte", "a.xml", every_byte(), {"a.xml", "binary"}},
      {"Program",
       "a.urdf",
       "\x7f"
       "ELF\x02\x01\x01" +
           std::string(500, '\0'),
       {"binary"}},
      {"ZeroByteInside", "a.xml", good + std::string(1, '\0') + good, {"binary"}},
      {"Utf16", "a.xml", utf16(good, true, true), {"UTF-16", "UTF-8"}},
      {"Utf16HighBytesFirst", "a.xml", utf16(good, false, true), {"UTF-16"}},
      {"Utf16WithoutMark", "a.xml", utf16(good, true, false), {"UTF-16"}},
      {"Utf16Urdf", "a.urdf", utf16("<robot name=\"r\"/>", false, false), {"UTF-16"}},
      {"TextOfOtherKind", "a.xml", "solid cube\nfacet normal 0 0 1\n", {"XML"}},
      {"Truncated", "a.xml", good.substr(0, good.size() / 2), {"a.xml:", "XML"}},
      {"TruncatedInAName", "a.urdf", "<robot name=\"r", {"a.urdf:1", "XML"}},
      {"TruncatedComment", "a.xml", "<mujoco><!-- and so on", {"a.xml:1", "XML"}},
      {"Latin1Name",
       "a.xml",
       mjcf("<geom name=\"H\xfc"
            "fte\" size=\"1\"/>"),
       {"a.xml:3: <geom", "\"name\"", "UTF-8"}},
      {"OverlongName", "a.xml", mjcf("<body name=\"\xc0\xaf\"/>"), {"a.xml:3: <body", "UTF-8"}},
      {"SurrogateInAName", "a.xml", mjcf("<body name=\"\xed\xa0\x80\"/>"), {"a.xml:3", "UTF-8"}},
      {"Latin1Element", "a.xml", mjcf("<g\xe9om/>"), {"a.xml:3", "UTF-8"}},
      {"LineBreakInAName",
       "a.xml",
       mjcf("<body name=\"a&#10;b\"/>"),
       {"a.xml:3", "control character"}},
      {"EscapeInAName",
       "a.xml",
       mjcf("<body name=\"&#27;[31m\"/>"),
       {"a.xml:3", "control character"}},
      {"NameOfAMillionBytes",
       "a.xml",
       +[] { return mjcf("<body name=\"" + std::string(1'000'000, 'n') + "\"/>"); },
       {"a.xml:3", "1000000 bytes"}},
      {"BillionLaughs",
       "a.xml",
       "<!DOCTYPE m [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;&a;\">]>\n"
       "<mujoco model=\"&b;\"/>",
       {"a.xml:"}},
      {"ExternalEntity",
       "a.xml",
       "<!DOCTYPE m SYSTEM \"file:///etc/passwd\">\n<mujoco/>",
       {"a.xml:1", "DOCTYPE"}},
      {"SecondRoot", "a.xml", good + "\n<mujoco/>", {"a.xml:5", "second root", "<mujoco>"}},
      {"AttributeTwice",
       "a.xml",
       mjcf("<geom size=\"1\" size=\"2\"/>"),
       {"a.xml:3", "<geom>", "twice"}},
      {"BodiesNestedAHundredThousandDeep",
       "a.xml",
       +[] { return nested("body", 100'000); },
       {"nested too deep"}},
      {"FramesNestedAHundredThousandDeep",
       "a.xml",
       +[] { return nested("frame", 100'000); },
       {"nested too deep"}},
      {"DefaultsNestedDeep",
       "a.xml",
       "<mujoco>" + repeat("<default class=\"a\">", 5000) + repeat("</default>", 5000) +
           "</mujoco>",
       {"nested too deep"}},
      {"OpenTagsAlone", "a.xml", +[] { return repeat("<a>", 1'000'000); }, {"a.xml"}},
      {"MillionsOfElements",
       "a.xml",
       +[] { return mjcf(repeat("<site/>", 2'000'000)); },
       {"more than 1000000 elements"}},
      {"MillionsOfAttributes",
       "a.xml",
       +[] { return mjcf("<site " + repeat("a='' ", 2'000'000) + "/>"); },
       {"more than 1000000"}},
      {"LongerThanAnyDescription",
       "a.xml",
       +[] { return mjcf(std::string(70'000'000, ' ')); },
       {"a.xml", "bytes"}},
      {"WrongRoot", "a.xml", "<svg/>", {"a.xml:1", "<svg>", "<mujoco>", "<robot>"}},
  };
}

}  // namespace mjarm::hostile
