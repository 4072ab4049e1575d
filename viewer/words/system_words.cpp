// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/words/system_words.h"

#include "artus/detail/viewer/words/retell.h"

namespace artus {
namespace {

constexpr const char* kSayings[] = {
    // NOLINT(*-avoid-c-arrays)
    msgid("haptics: {}"),
    msgid("imaging: {}"),
    msgid("SCHED_FIFO priority: {}"),
    msgid("nice value {}: {}"),
    msgid("locking memory: {}"),
    msgid("one processor: {}"),
    msgid("imaging failed: {}; trying again"),
    msgid("the tissue stays rigid: {}"),
    msgid("a body without tetrahedra cannot give way"),
    msgid("no skin below the probe: move it over the body"),
    msgid("no bone '{}' holds the tissue around the probe"),
    msgid("the tissue does not follow the bones so far"),
    msgid("an image of {} x {} pixels is too large for IMAGE"),
    msgid("shared memory {} was cut off; {}"),
    msgid("shared memory {} cannot be read; {}"),
    msgid("shared memory {} was removed; {}"),
    msgid("shared memory {} was replaced; {}"),
    msgid("shared memory {} was overwritten; {}"),
    msgid("recreated"),
    msgid("the recording cannot be written: {}"),
    msgid(
        "the device's plunger went faster than a thumb can push it: refused, it begins anew where "
        "it is, without a force"),
    msgid("this shared memory does not exist; start `artus serve` first"),
    msgid("the shared memory belongs to another user"),
    msgid("damaged shared memory of an earlier run could not be replaced"),
    msgid("reading and repairing surfaces"),
    msgid("measuring distances"),
    msgid("finding boundaries"),
    msgid("meshing boundaries"),
    msgid("resolving overlaps"),
    msgid("fitting interfaces"),
    msgid("measuring interfaces"),
    msgid("filling with tetrahedra"),
    msgid("measuring tetrahedra"),
    msgid("done"),
    msgid("the records: {}; check that its folder exists and may be written"),
    msgid("the records: {}; check that there is space left (what was stored before is kept)"),
    msgid("the records: {}; another program is using it, try again"),
    msgid("database is locked"),
    msgid("attempt to write a readonly database"),
    msgid("unable to open database file"),
    msgid("database or disk is full"),
    msgid("disk I/O error"),
    msgid("cannot make the attempt's folder: {}"),
    msgid("an unknown failure"),
    msgid("Operation not permitted"),
    msgid("Permission denied"),
    msgid("Cannot allocate memory"),
    msgid("Resource temporarily unavailable"),
    msgid("Invalid argument"),
    msgid("No space left on device"),
    msgid("No such file or directory"),
    msgid("std::bad_alloc"),
    msgid("mouse and keyboard"),
    msgid("simulated hand"),
    msgid("recorded file"),
    msgid("shared memory"),
    msgid("OpenIGTLink"),
};

}  // namespace

std::string said_by_system(Language language, const std::string& english) {
  return retell(language, kSayings, english);
}

}  // namespace artus
