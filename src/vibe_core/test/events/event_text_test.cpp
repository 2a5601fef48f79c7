// What people read about events: every kind and every reason has a name and a sentence, and numbers have units.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>

#include "events/event_table.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::event_text_test {
namespace {

using Kind = Event::Kind;

Event filled(Kind kind, EventDetail detail) {
  Event event;
  event.kind = kind;
  event.detail = detail;
  event.region = Region::Antrum;
  event.wall = Wall::Posterior;
  event.value = 2;
  event.limit = 3;
  event.amount = 4;
  event.suture = 4;
  event.bite = 6;
  return event;
}

/// Numbers of a text without a unit, beside those of bites and sets. Empty: none.
std::string bareNumbers(const std::string& text) {
  const std::regex with_unit("[0-9.]+ (mmHg|mm|N|ml per minute|ml|turns|bites?|marks?|sets?|particles?)(?![a-zA-Z])");
  const std::regex ordinal("([Bb]ite|[Ss]et) [0-9]+");
  const std::string rest = std::regex_replace(std::regex_replace(text, ordinal, ""), with_unit, "");
  return std::regex_search(rest, std::regex("[0-9]")) ? rest : "";
}

void expectSentence(const std::string& text) {
  ASSERT_FALSE(text.empty());
  EXPECT_EQ(text.find_first_of("{}?"), std::string::npos) << text;
  EXPECT_EQ(text.back(), '.') << text;
  EXPECT_TRUE(std::isupper(static_cast<unsigned char>(text[0])) || std::isdigit(static_cast<unsigned char>(text[0])))
      << text;
  EXPECT_EQ(bareNumbers(text), "") << text;
}

TEST(EventText, EveryKindHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int k = 0; k < kEventKindCount; ++k) {
    const std::string name = toString(static_cast<Kind>(k));
    EXPECT_NE(name, "unknown") << k;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
  EXPECT_STREQ(toString(static_cast<Kind>(kEventKindCount)), "unknown");
  EXPECT_STREQ(toString(Kind::Rejected), "rejected");
}

TEST(EventText, EveryReasonHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int k = 0; k < kRejectReasonCount; ++k) {
    const std::string name = toString(static_cast<RejectReason>(k));
    EXPECT_NE(name, "unknown") << k;
    EXPECT_TRUE(names.insert(name).second) << name;
  }
  EXPECT_STREQ(toString(static_cast<RejectReason>(kRejectReasonCount)), "unknown");
}

TEST(EventText, EveryKindAndDetailHasASentenceWithUnits) {
  std::set<EventDetail> details;
  std::set<std::string> sentences;
  for (const EventRow& row : eventRows()) {
    EXPECT_STREQ(row.name, toString(row.kind)) << "rows of a kind share a name";
    EXPECT_STREQ(row.unit, unitOfValue(row.kind)) << "and a unit";
    details.insert(row.detail);
    if (row.kind == Kind::Rejected) continue;
    const std::string text = describe(filled(row.kind, row.detail));
    expectSentence(text);
    EXPECT_TRUE(sentences.insert(text).second) << text;
  }
  EXPECT_EQ(details.size(), static_cast<std::size_t>(kEventDetailCount)) << "each detail is used";
}

TEST(EventText, EveryReasonHasASentenceWithUnits) {
  std::set<std::string> sentences;
  for (int k = 0; k < kRejectReasonCount; ++k) {
    Event event = filled(Kind::Rejected, EventDetail::None);
    event.reason = static_cast<RejectReason>(k);
    const std::string text = describe(event);
    expectSentence(text);
    EXPECT_TRUE(sentences.insert(text).second) << text;
    const bool has_remedy = text.find(": ") != std::string::npos || text.find("; ") != std::string::npos;
    EXPECT_TRUE(has_remedy || k == 0) << "a reason says what to do: " << text;
  }
}

// The checks above fail when they should.
TEST(EventText, FaultyTemplatesAreFound) {
  const Event event = filled(Kind::Slip, EventDetail::None);
  for (const char* faulty : {"At {value:furlongs}.", "At {value}.", "At {size:mm}.", "The {nothing}."})
    EXPECT_NE(fillIn(faulty, event).find('?'), std::string::npos) << faulty;
  EXPECT_EQ(fillIn("Open {value:mm", event), "Open {value:mm");
  EXPECT_NE(bareNumbers("It tore off at 12.0."), "");
  EXPECT_NE(bareNumbers("It tore off at 12.0 Newtons."), "");
  EXPECT_EQ(bareNumbers("Bite 3 of set 2 tore out at 12.00 N."), "");
}

TEST(EventText, SaysWhatHappened) {
  Event slip = filled(Kind::Slip, EventDetail::None);
  slip.value = 2.345;
  slip.amount = 1.5;
  EXPECT_EQ(describe(slip), "The tissue tore off the helix at 2.35 N; after 1.5 turns the helix holds 3.00 N.");
  Event bite = filled(Kind::Bite, EventDetail::PartialThickness);
  bite.value = 1.5e-3;
  bite.amount = 0.0204;
  EXPECT_EQ(describe(bite),
            "Bite 7 of set 5: partial thickness, 1.5 mm deep, antrum, posterior wall, 20.4 mm from the previous bite.");
  bite.bite = 0;
  EXPECT_EQ(describe(bite), "Bite 1 of set 5: partial thickness, 1.5 mm deep, antrum, posterior wall.");
  Event bleeding = filled(Kind::BleedingBrisk, EventDetail::None);
  bleeding.value = 2.5e-7;
  EXPECT_EQ(describe(bleeding), "Bite 7 of set 5 bleeds briskly, 15.00 ml per minute; complete and cinch the set.");
  Event pressure = filled(Kind::PressureReached, EventDetail::None);
  pressure.value = 1999.83;
  EXPECT_EQ(describe(pressure), "The insufflator has reached its set point at 15.0 mmHg.");
  Event technique = filled(Kind::TechniqueFound, EventDetail::None);
  technique.value = static_cast<double>(Technique::Running);
  EXPECT_EQ(describe(technique), "The bites of set 5 form the pattern 'running'.");
}

TEST(EventText, CountsOneAndMany) {
  Event mark = filled(Kind::Mark, EventDetail::InZone);
  mark.amount = 1;
  EXPECT_EQ(describe(mark), "A mark begins (wall posterior, region antrum), 1 mark in total.");
  mark.amount = 2;
  EXPECT_EQ(describe(mark), "A mark begins (wall posterior, region antrum), 2 marks in total.");
}

TEST(EventText, ARejectionNamesTheButtonAndTheRemedy) {
  for (int button = 0; button < kButtonCount; ++button) {
    Event event;
    event.kind = Kind::Rejected;
    event.reason = RejectReason::NoMarking;
    event.value = button;
    EXPECT_EQ(describe(event), std::string("The button '") + kButtonNames[button] +
                                   "' has no effect: the scene has no section 'marking'; add `marking:` to it.");
  }
  Event arm;
  arm.kind = Kind::Rejected;
  arm.reason = RejectReason::ClosedWithoutNeedle;
  arm.value = -1;
  expectSentence(describe(arm));
}

/// A string literal with a space in a line of code; empty: none.
std::string sentenceIn(const std::string& line) {
  std::smatch found;
  const std::string code = line.substr(0, line.find("//"));
  return std::regex_search(code, found, std::regex("\"[^\"]* [^\"]*\"")) ? found.str() : "";
}

TEST(EventText, ThePhysicsFormsNoSentences) {
  EXPECT_NE(sentenceIn("  emit(Kind::Slip, \"The tissue tore off.\");"), "") << "the check finds one";
  EXPECT_EQ(sentenceIn("  if (model == \"groups\") {  // as in \"The tissue\""), "");
  int files = 0;
  for (const char* room : {"procedure", "dynamics"})
    for (const auto& file : std::filesystem::directory_iterator(std::string(VIBE_CORE_DIR) + "/src/" + room)) {
      ++files;
      std::ifstream text(file.path());
      for (std::string line; std::getline(text, line);) EXPECT_EQ(sentenceIn(line), "") << file.path();
    }
  EXPECT_GT(files, 10);
}

TEST(EventText, AnEventWithoutItsDetailShowsItsName) {
  EXPECT_EQ(describe(filled(Kind::Recovery, EventDetail::None)), "recovery.");
  EXPECT_EQ(describe(filled(static_cast<Kind>(200), EventDetail::None)), "");
}

}  // namespace
}  // namespace vibe::event_text_test
