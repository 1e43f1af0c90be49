// SPDX-License-Identifier: GPL-3.0-or-later
// What goes wrong at an emulated printer, and when.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace binderjet {

enum class PrinterFault {
  // The data pipe, in the middle of a layer's bytes.
  kNak,         // takes nothing for `ms`
  kStall,       // halts the pipe
  kShortWrite,  // a transfer succeeds with fewer bytes than it had
  kSwallow,     // bytes are taken and lost
  kFlipBit,     // a bit arrives wrong
  kReset,       // the firmware restarts: the session is forgotten, the job is not
  kGone,        // unplugged until plug()
  kPowerLoss,   // the same, and all that was not acknowledged is forgotten
  // The answering pipe, at the layer's acknowledgement.
  kStallIn,         // halts the pipe before the acknowledgement
  kLoseAck,         // the acknowledgement is not said
  kRepeatAck,       // said twice
  kLateAck,         // said after `ms`
  kGoneBeforeAck,   // acknowledged inside, unplugged before it is said
  kAckTooFar,       // for a layer that was not sent
  kAckOtherJob,     // for another job
  kAckWrongDigest,  // for other bytes
  kNoise,           // rubbish before it
  kLyingLength,     // a frame that claims 4 GiB
  kShortLength,     // a frame that is longer than it claims
  kUnknownType,     // a frame of a type that does not exist
  kSkipSequence,    // an answer's number is left out
  kByteByByte,      // from here on answers come a byte at a time
  kEmptyAnswers,    // packets without a byte, again and again
  kSilent,          // no answer for `ms`
  kWrongStatus,     // a status that contradicts the acknowledgements
  kStrangeStatus,   // a status with reasons nobody knows
  // The printer itself, before it prints the layer.
  kOutOfPowder,  // stopped, media-empty, until refill()
  kOutOfBinder,  // stopped, marker-supply-empty, until refill()
  kCoverOpen,    // stopped, cover-open, until refill()
  kPaused,       // stopped, paused, for `ms`
  kSlow,         // each layer from here on takes `ms`
  kNoCredit,     // lends no room for `ms`
  // Sessions and the end.
  kNoHello,         // does not answer a greeting
  kOldVersion,      // greets with a version nobody speaks
  kWrongDone,       // the end has another digest
  kLoseDone,        // the end is not said
  kGoneBeforeDone,  // unplugged after printing the last layer and before saying so
  // Control requests.
  kStallDeviceId,    // GET_DEVICE_ID is not there
  kSwappedDeviceId,  // its length is little-endian
  kResetClass10,     // SOFT_RESET only in the form of class 1.0
  kPortStatus,       // GET_PORT_STATUS says paper empty and error
  kHangControl,      // no control request is ever answered
  kForgetsJob,       // loses what it had acknowledged: no printer may
};

struct PlannedFault {
  PrinterFault what;
  int layer = 0;  // when this layer is due; sessions and control requests: at once
  int times = 1;  // how often it happens; -1 until it is healed
  int ms = 0;     // for how long, where it lasts
};

using FaultPlan = std::vector<PlannedFault>;

const char* fault_word(PrinterFault fault);
// "stall@12x3:50" is a stall at layer 12, three times, 50 ms; nothing if it is not that.
std::optional<PlannedFault> parse_fault(const std::string& text);
std::string to_text(const PlannedFault& fault);
// All there are, for tables and random plans.
const std::vector<PrinterFault>& all_printer_faults();

}  // namespace binderjet
