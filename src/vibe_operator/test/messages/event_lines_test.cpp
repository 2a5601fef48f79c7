#include "vibe_operator/messages/table_rows.hpp"

#include <gtest/gtest.h>

namespace vibe::operating::event_lines_test {
namespace {

using Event = vibe_msgs::ProcedureEvent;

Event makeEvent(std::uint8_t kind, const std::string& text) {
  Event event;
  event.kind = kind;
  event.text = text;
  return event;
}

TEST(EventLines, severities) {
  for (const std::uint8_t kind : {Event::WARNING, Event::REJECTED, Event::SLIP, Event::CINCH_LOOSE, Event::BITE_MISSED})
    EXPECT_EQ(severityOf(kind), EventSeverity::Warning) << int{kind};
  for (const std::uint8_t kind : {Event::BLEEDING_MILD, Event::BLEEDING_BRISK, Event::BLEEDING_OVERDUE})
    EXPECT_EQ(severityOf(kind), EventSeverity::Bleeding) << int{kind};
  for (const std::uint8_t kind : {Event::TEAR_OUT, Event::THREAD_BROKE, Event::DEEP_BURN})
    EXPECT_EQ(severityOf(kind), EventSeverity::Harm) << int{kind};
  for (const std::uint8_t kind : {Event::BITE, Event::CINCHED, Event::BLEEDING_STOPPED})
    EXPECT_EQ(severityOf(kind), EventSeverity::Success) << int{kind};
  for (const std::uint8_t kind : {Event::GRAB, Event::PHASE_CHANGED, Event::MARK})
    EXPECT_EQ(severityOf(kind), EventSeverity::Note) << int{kind};
}

TEST(EventLines, aKindFromTheFutureIsANote) {
  EXPECT_EQ(severityOf(200), EventSeverity::Note);
  EXPECT_EQ(eventText(makeEvent(200, "Something new.")), "Something new.");
}

TEST(EventLines, textOrTitle) {
  EXPECT_EQ(eventText(makeEvent(Event::REJECTED, "No needle.")), "Rejected: No needle.");
  EXPECT_EQ(eventText(makeEvent(Event::TEAR_OUT, "Bite 2 tore out.")), "Bite 2 tore out.");
  EXPECT_EQ(eventText(makeEvent(Event::TEAR_OUT, "")), "Tear-out.");
  EXPECT_EQ(eventText(makeEvent(200, "")), "Event.");
  EXPECT_EQ(eventText(makeEvent(Event::ARM_CLOSED, "")), "Arm closed.");
}

TEST(EventLines, contactsAreNotListed) {
  EXPECT_FALSE(isListed(makeEvent(Event::CONTACT_BEGIN, "")));
  EXPECT_FALSE(isListed(makeEvent(Event::CONTACT_END, "")));
  EXPECT_TRUE(isListed(makeEvent(Event::SLIP, "")));
}

}  // namespace
}  // namespace vibe::operating::event_lines_test
