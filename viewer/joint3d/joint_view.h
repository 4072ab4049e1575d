// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <array>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "artus/detail/anatomy/outside/outside_body.h"
#include "artus/detail/viewer/joint3d/body_shape.h"
#include "artus/detail/viewer/joint3d/colours.h"
#include "artus/detail/viewer/joint3d/gl_objects.h"
#include "artus/detail/viewer/joint3d/joint_sheets.h"
#include "artus/detail/viewer/joint3d/orbit_camera.h"
#include "artus/detail/viewer/joint3d/surface_detail.h"
#include "artus/session/session.h"

namespace artus {

/// How one tissue is drawn.
struct TissueLook {
  std::string name;
  Eigen::Vector3f colour = Eigen::Vector3f::Ones();  ///< red, green, blue, 0 to 1
  float alpha = 1;
  bool visible = true;
};

/// A colour as a TissueLook has it.
[[nodiscard]] Eigen::Vector3f look_colour(const Rgb& colour) noexcept;

/// What there is to draw besides the joint.
struct JointScene {
  const HapticSnapshot& now;   ///< its hands at the image's instant, where that is not an old one
  Pose X_JN;                   ///< the needle as it is, held by bone where the hand goes on
  BodyState body;              ///< of the image
  const ImageSnapshot* image;  ///< null when there is none
  const GlTexture& image_texture;
  const std::optional<EntryChoice>& entry;  ///< where the needle would enter
};

/// A structure's name where its middle stands in the picture.
struct ScreenLabel {
  std::string name;
  float x = 0;  ///< pixels from the left
  float y = 0;  ///< pixels from the top
};

/// The joint in three dimensions with probe, needle, image plane, insertion cone, forces and the
/// tip's trail, its surfaces where they lie in the image's body: pressed, pushed by the needle,
/// lifted by liquid. Of that only what moved is sent to the graphics again. Draws frame J. Needs a
/// current OpenGL 3.3 context for its whole life.
class JointView {
 public:
  static constexpr double kRequestedTime = 25e-3;     ///< s that a call may take
  static constexpr double kFirstTime = 150e-3;        ///< s, while nothing is shown yet
  static constexpr double kRequestedPicture = 50e-3;  ///< s that a picture may take in all

  /// `outside`: the person around the joint; null: the joint stands alone.
  [[nodiscard]] static Result<std::unique_ptr<JointView>> make(
      std::shared_ptr<const CompiledJoint> joint, double probe_width, double needle_length,
      std::shared_ptr<const OutsideBody> outside = nullptr);

  /// Draws into a picture of its own, when anything in it moved since the last one, and returns the
  /// texture of the newest whole one; 0 before there is any. What takes longer than kRequestedTime
  /// is gone on with by the next calls, so that a slow picture holds nobody up; how finely the
  /// surfaces are drawn follows from the time that it takes.
  unsigned draw(int width, int height, const JointScene& scene);
  /// Whether the last call ended a picture, the seconds that this took in all its calls, and at
  /// which level of detail the next is drawn (DetailChooser).
  [[nodiscard]] bool drew() const noexcept { return drew_; }
  /// Whether a picture is in the making, for the next call to go on with.
  [[nodiscard]] bool making() const noexcept { return making_; }
  [[nodiscard]] double took() const noexcept { return took_; }
  [[nodiscard]] std::size_t level() const noexcept { return detail_.level(); }
  /// Number of the image in the picture that draw() returned last, and of points that were sent
  /// again for its body; 0: none.
  [[nodiscard]] std::uint64_t image_shown() const noexcept { return image_shown_; }
  [[nodiscard]] std::size_t points_sent() const noexcept { return points_sent_; }
  /// Names of what is drawn and opaque enough to be seen, by the last picture's camera.
  [[nodiscard]] std::vector<ScreenLabel> labels(int width, int height) const;

  /// Bones that can be felt, on the person's side that is seen, and the letters R and L of the
  /// sides, by the last picture's camera. Empty without a person.
  [[nodiscard]] std::vector<ScreenLabel> landmarks(int width, int height) const;
  [[nodiscard]] std::vector<ScreenLabel> sides(int width, int height) const;
  /// The bone that is felt where a needle's tip touches the skin; empty: none.
  [[nodiscard]] std::string felt_at(const Vec3& tip) const;
  /// The whole person with the joint's place in colour, drawn once; 0 without a person.
  unsigned overview();
  static constexpr int kOverviewWidth = 240;   ///< pixels
  static constexpr int kOverviewHeight = 360;  ///< pixels

  std::vector<TissueLook>& looks() noexcept { return looks_; }
  OrbitCamera& camera() noexcept { return camera_; }
  bool cut_away = true;  ///< hide what lies before the image plane
  void clear_trail() { trail_.clear(); }

 private:
  JointView(std::shared_ptr<const CompiledJoint> joint, GlProgram solid, GlProgram picture,
            double probe_width, double needle_length);
  [[nodiscard]] Result<void> show_outside(std::shared_ptr<const OutsideBody> outside);
  void draw_outside(const Eigen::Matrix4f& view, const Vec3& eye, bool marked);
  [[nodiscard]] std::optional<ScreenLabel> on_screen(std::string name, const Vec3& p, int width,
                                                     int height) const;
  /// What is named; without a name it has a look alone.
  struct Part {
    std::size_t look;
    std::string name;
    Vec3 centre = Vec3::Zero();  // at rest
    std::uint32_t nearest = 0;   // vertex that the centre goes with
    Vec3 making = Vec3::Zero();  // the centre in the picture in the making
    Vec3 shown = Vec3::Zero();   // in the shown one
  };
  static constexpr std::size_t kNoPart = static_cast<std::size_t>(-1);
  struct DrawnSheet {
    Sheet sheet;
    bool injected = false;  // of the body's joint, not of this one
    std::array<std::unique_ptr<MovingMesh>, DetailChooser::kLevels>
        meshes;  // made when first drawn
  };
  /// How a surface looks from one of its sides; alpha 0: not at all.
  struct Side {
    Eigen::Vector4f colour;
    bool lit;
  };
  /// A sheet, and how it is drawn.
  struct Step {
    DrawnSheet* sheet;
    Side front;
    Side behind;
    bool veil;
  };
  using Clock = std::chrono::steady_clock;
  void find_parts();
  void find_centres();
  void take_body(const BodyState& body);
  void show_injected();
  void move_to_body();
  [[nodiscard]] const VertexPlaces& places_of(const DrawnSheet& sheet) const noexcept;
  const GlMesh& mesh_of(DrawnSheet& sheet);
  [[nodiscard]] Side side_of(RegionId region) const;
  void set_sides(const Side& front, const Side& behind);
  [[nodiscard]] std::optional<Step> opaque_step(DrawnSheet& sheet) const;
  void plan_steps();
  void begin_picture(int width, int height, const JointScene& scene);
  void begin_sheets(const Eigen::Vector4f& plane);
  void go_on(Clock::time_point begin);
  [[nodiscard]] bool moved(int width, int height, const JointScene& scene);
  void draw_tools(const Eigen::Matrix4f& view, const JointScene& scene);
  void draw_forces(const Eigen::Matrix4f& view, const HapticSnapshot& now);
  void draw_entry(const Eigen::Matrix4f& view, const EntryChoice& entry);
  void draw_image(const Eigen::Matrix4f& view, const ImageSnapshot& image,
                  const GlTexture& texture);
  void draw_trail(const Eigen::Matrix4f& view, const Pose& X_JN);
  void draw_mesh(const GlMesh& mesh, const Eigen::Matrix4f& view, const Eigen::Matrix4f& model,
                 const Eigen::Vector4f& colour, bool lit);

  std::shared_ptr<const CompiledJoint> joint_;
  GlProgram solid_;
  GlProgram picture_;
  std::array<GlTarget, 2> targets_;
  std::optional<std::size_t> shown_;  // of targets_, the newest whole picture
  std::vector<Part> parts_;
  std::vector<std::size_t> part_of_;  // by region; kNoPart: none
  std::vector<DrawnSheet> sheets_;
  std::vector<DrawnSheet> injected_;  // of injected_joint_
  std::shared_ptr<const CompiledJoint> injected_joint_;
  std::vector<TissueLook> looks_;
  OrbitCamera camera_;
  Vec3 eye_ = Vec3::Zero();
  GlMesh box_;
  GlMesh rod_;
  GlMesh cone_;
  GlMesh quad_;
  GlMesh line_;
  std::shared_ptr<const OutsideBody> outside_;
  std::optional<GlProgram> person_;
  GlMesh skin_;
  GlTarget overview_;
  bool overview_drawn_ = false;
  std::deque<Eigen::Vector3f> trail_;
  DetailChooser detail_{kRequestedPicture};
  std::vector<double> seen_;  // what decided how the last picture looks
  BodySight sight_;
  bool drew_ = false;
  std::uint64_t image_shown_ = 0;
  std::size_t points_sent_ = 0;
  Eigen::Matrix4f view_ = Eigen::Matrix4f::Identity();  // of the shown picture
  // The picture in the making.
  bool making_ = false;
  std::vector<Step> steps_;
  std::size_t next_step_ = 0;
  HapticSnapshot now_;
  BodyState body_;
  VertexPlaces places_;           // in `body_`, of the joint's sheets
  VertexPlaces injected_places_;  // of what was injected
  std::uint64_t image_ = 0;
  std::size_t sending_ = 0;
  Eigen::Matrix4f making_view_ = Eigen::Matrix4f::Identity();
  Eigen::Vector4f plane_ = Eigen::Vector4f::Zero();
  double took_ = 0;  // s
  double probe_width_;
  double needle_length_;
};

}  // namespace artus
