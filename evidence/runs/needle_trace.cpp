// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/runs/needle_trace.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>

#include "artus/detail/core/csv.h"

namespace artus {
namespace {

constexpr const char* kHeader =
    "time_s,pass,tip_x_m,tip_y_m,tip_z_m,q_w,q_x,q_y,q_z,state,layer,depth_m,velocity_m_s,wall_m,"
    "cone_rad,deviation_m,in_bone_m,incoming_speed_m_s,prepuncture_n,cutting_n,attracted_n,"
    "friction_n,hard_n,"
    "clamping_x_n,clamping_y_n,clamping_z_n,clamping_n,torque_x_nm,torque_y_nm,torque_z_nm,"
    "total_x_n,total_y_n,total_z_n,total_axial_n,command_x_n,command_y_n,command_z_n,"
    "command_torque_x_nm,command_torque_y_nm,command_torque_z_nm,hand_axial_n,energy_to_hand_j,"
    "events,status";

void add(std::string& line, double value) {
  line += to_csv(value);
  line += ',';
}

void add(std::string& line, const Vec3& v) {
  for (const double c : v) add(line, c);
}

}  // namespace

std::string needle_csv_header() {
  return kHeader;
}

std::string needle_csv_line(const NeedleRow& row, std::span<const std::string> region_names) {
  const NeedleForces& f = row.forces;
  const Eigen::Quaterniond q(row.X_JN.linear());
  std::string line;
  line.reserve(512);
  add(line, row.time);
  line += std::to_string(row.pass) + ',';
  add(line, row.X_JN.translation());
  for (const double c : {q.w(), q.x(), q.y(), q.z()}) add(line, c);
  line += to_string(row.state);
  line += ',';
  if (row.region < region_names.size()) line += region_names[row.region];
  line += ',';
  for (const double c :
       {row.depth, row.velocity, row.wall, row.cone, row.deviation, row.in_bone, row.incoming_speed,
        f.prepuncture, f.cutting, f.attracted, f.friction, f.hard}) {
    add(line, c);
  }
  add(line, f.clamping);
  add(line, f.clamping.norm());
  add(line, f.torque);
  add(line, f.total.force);
  add(line, f.total.force.dot(row.axis));
  add(line, row.command.force);
  add(line, row.command.torque);
  add(line, row.hand.dot(row.axis));
  add(line, row.energy_to_hand);
  line += std::to_string(row.events) + ',' + std::to_string(row.status);
  return line;
}

NeedleRow make_needle_row(double time, const Pose& X_JN, const RenderedNeedle& rendered,
                          const NeedleModel& model) {
  const NeedleContact& contact = model.contact();
  const NeedleTick& tick = contact.tick();
  NeedleRow row;
  row.time = time;
  row.X_JN = X_JN;
  row.state = contact.state();
  row.events = contact.events();
  row.status = rendered.status;
  row.region = contact.region();
  row.axis = tick.axis;
  row.cone = contact.cone();
  row.forces = rendered.forces;
  row.command = rendered.command;
  row.incoming_speed = model.hard_contact().incoming_speed();
  if (row.state == ContactState::away) return row;
  row.depth = tick.depth + tick.pushed;
  row.pushed = tick.pushed;
  row.velocity = tick.velocity;
  row.wall = model.wall().wall();
  row.in_bone = std::max(0.0, tick.depth - tick.bone_depth);
  row.deviation = (tick.tip - tick.entry - tick.depth * tick.axis).norm();
  return row;
}

Result<void> write_needle_csv(const std::filesystem::path& file, std::span<const NeedleRow> rows,
                              std::span<const std::string> region_names, const MoreColumns& more) {
  std::ofstream out(file, std::ios::binary);
  out << kHeader << more.header << '\n';
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::string line = needle_csv_line(rows[i], region_names);
    if (more.append) more.append(i, line);
    out << line << '\n';
  }
  out.close();
  if (!out) return fail(ErrorCode::unreadable, "cannot write the trace", file.string());
  return {};
}

}  // namespace artus
