// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/viewer/words/anatomy_names.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace artus {
namespace {

struct Name {
  std::string_view name;
  const char* french;
};

constexpr std::array<Name, 146> kFrench{
    {{"outside", "hors du corps"},
     {"beyond", "hors du modèle"},
     {"skin", "peau"},
     {"fat", "graisse"},
     {"subcutaneous_fat", "graisse"},
     {"muscle", "muscle"},
     {"tendon", "tendon"},
     {"bone", "os"},
     {"bursa", "bourse"},
     {"nerve", "nerf"},
     {"artery", "artère"},
     {"vein", "veine"},
     {"blood", "sang"},
     {"ligament", "ligament"},
     {"capsule", "capsule"},
     {"cartilage", "cartilage"},
     {"labrum", "bourrelet"},
     {"fascia", "fascia"},
     {"synovial_fluid", "liquide synovial"},
     {"fluid", "liquide"},
     {"joint_fluid", "liquide articulaire"},
     {"humerus", "humérus"},
     {"calcific_deposit", "calcification"},
     {"calcification", "calcification"},
     {"supraspinatus_tear", "rupture du supra-épineux"},
     {"posterior_recess", "récessus postérieur"},
     {"acromioclavicular_cavity", "interligne acromio-claviculaire"},
     {"suprascapular_artery", "artère suprascapulaire"},
     {"transverse_scapular_ligament", "ligament transverse de la scapula"},
     {"suprascapular_canal", "canal suprascapulaire"},
     {"trapezius", "trapèze"},
     {"saline", "sérum physiologique"},
     {"lidocaine", "lidocaïne"},
     {"steroid", "corticoïde"},
     {"steroid_mixture", "mélange de corticoïde"},
     {"scapula", "scapula"},
     {"clavicle", "clavicule"},
     {"femur", "fémur"},
     {"tibia", "tibia"},
     {"patella", "patella"},
     {"pelvis", "bassin"},
     {"acetabulum", "acétabulum"},
     {"humeral_cartilage", "cartilage huméral"},
     {"glenoid_cartilage", "cartilage glénoïdien"},
     {"glenoid_labrum", "bourrelet glénoïdien"},
     {"acetabular_labrum", "bourrelet acétabulaire"},
     {"axillary_nerve", "nerf axillaire"},
     {"suprascapular_nerve", "nerf suprascapulaire"},
     {"femoral_nerve", "nerf fémoral"},
     {"femoral_artery", "artère fémorale"},
     {"femoral_vein", "veine fémorale"},
     {"circumflex_artery", "artère circonflexe"},
     {"circumflex_vein", "veine circonflexe"},
     {"axillary_artery", "artère axillaire"},
     {"axillary_vein", "veine axillaire"},
     {"subacromial_bursa", "bourse sous-acromiale"},
     {"biceps_long_tendon", "tendon du long biceps"},
     {"supraspinatus_tendon", "tendon du supra-épineux"},
     {"infraspinatus_tendon", "tendon de l'infra-épineux"},
     {"teres_minor_tendon", "tendon du petit rond"},
     {"subscapularis_tendon", "tendon du subscapulaire"},
     {"quadriceps_tendon", "tendon du quadriceps"},
     {"patellar_tendon", "tendon patellaire"},
     {"biceps_sheath", "gaine du biceps"},
     {"glenohumeral_capsule", "capsule gléno-humérale"},
     {"supraspinatus", "supra-épineux"},
     {"infraspinatus", "infra-épineux"},
     {"teres_minor", "petit rond"},
     {"subscapularis", "subscapulaire"},
     {"deltoid", "deltoïde"},
     {"deltoid_acromial", "deltoïde acromial"},
     {"deltoid_clavicular", "deltoïde claviculaire"},
     {"deltoid_spinal", "deltoïde spinal"},
     {"iliopsoas", "ilio-psoas"},
     {"suprapatellar_recess", "récessus suprapatellaire"},
     {"fibula", "fibula"},
     {"femoral_cartilage", "cartilage fémoral"},
     {"patellar_cartilage", "cartilage patellaire"},
     {"medial_tibial_cartilage", "cartilage tibial médial"},
     {"lateral_tibial_cartilage", "cartilage tibial latéral"},
     {"medial_meniscus", "ménisque médial"},
     {"lateral_meniscus", "ménisque latéral"},
     {"popliteal_artery", "artère poplitée"},
     {"popliteal_vein", "veine poplitée"},
     {"tibial_nerve", "nerf tibial"},
     {"medial_collateral_ligament", "ligament collatéral médial"},
     {"lateral_collateral_ligament", "ligament collatéral latéral"},
     {"rectus_femoris", "droit fémoral"},
     {"vastus_medialis", "vaste médial"},
     {"vastus_lateralis", "vaste latéral"},
     {"medial_gastrocnemius", "gastrocnémien médial"},
     {"lateral_gastrocnemius", "gastrocnémien latéral"},
     {"semimembranosus", "semi-membraneux"},
     {"biceps_femoris", "biceps fémoral"},
     {"acetabular_cartilage", "cartilage acétabulaire"},
     {"anterior_recess", "récessus antérieur"},
     {"hip_capsule", "capsule de la hanche"},
     {"sartorius", "sartorius"},
     {"tensor_fasciae_latae", "tenseur du fascia lata"},
     {"gluteus_medius", "moyen fessier"},
     {"gluteus_maximus", "grand fessier"},
     {"adductor_longus", "long adducteur"},
     {"rib_3", "3e côte"},
     {"rib_4", "4e côte"},
     {"acromioclavicular_disc", "disque acromio-claviculaire"},
     {"axillary_muscular_branches", "rameaux musculaires du nerf axillaire"},
     {"superior_lateral_brachial_cutaneous_nerve", "nerf cutané latéral supérieur du bras"},
     {"musculocutaneous_nerve", "nerf musculo-cutané"},
     {"radial_nerve", "nerf radial"},
     {"median_nerve", "nerf médian"},
     {"ulnar_nerve", "nerf ulnaire"},
     {"posterior_cord", "faisceau postérieur"},
     {"brachial_artery", "artère brachiale"},
     {"cephalic_vein", "veine céphalique"},
     {"biceps_short_tendon", "tendon du court biceps"},
     {"pectoralis_major_tendon", "tendon du grand pectoral"},
     {"coracoacromial_ligament", "ligament coraco-acromial"},
     {"coracohumeral_ligament", "ligament coraco-huméral"},
     {"transverse_humeral_ligament", "ligament huméral transverse"},
     {"conoid_ligament", "ligament conoïde"},
     {"trapezoid_ligament", "ligament trapézoïde"},
     {"acromioclavicular_capsule", "capsule acromio-claviculaire"},
     {"teres_major", "grand rond"},
     {"biceps_long", "long biceps"},
     {"biceps_short", "court biceps"},
     {"coracobrachialis", "coraco-brachial"},
     {"triceps_long", "long triceps"},
     {"triceps_lateral", "triceps latéral"},
     {"triceps_medial", "triceps médial"},
     {"latissimus_dorsi", "grand dorsal"},
     {"pectoralis_major_sternocostal", "grand pectoral sterno-costal"},
     {"pectoralis_major_clavicular", "grand pectoral claviculaire"},
     {"pectoralis_major_abdominal", "grand pectoral abdominal"},
     {"pectoralis_minor", "petit pectoral"},
     {"serratus_anterior", "dentelé antérieur"},
     {"trapezius_transverse", "trapèze transverse"},
     {"trapezius_ascending", "trapèze ascendant"},
     {"upper_bursa", "haut de la bourse"},
     {"lower_bursa", "bas de la bourse"},
     {"bursa_over_tendon", "bourse, sur le tendon"},
     {"bursa_beside_tuberosity", "bourse, près du tubercule"},
     {"lateral_recess", "récessus latéral"},
     {"middle_recess", "milieu du récessus"},
     {"recess_near_the_head", "récessus, près de la tête"},
     {"recess_on_the_neck", "récessus, sur le col"},
     {"injected", "liquide injecté"}}};

bool is_filling(const CompiledJoint& joint, RegionId region) {
  return region == kFirstRegion && joint.tissue_of(region).acoustic.kind == TissueKind::fat;
}

/// The tissue's name of the stretch beside the k-th; empty where there is none.
std::string_view tissue_beside(const CompiledJoint& joint, std::span<const TissueInterval> line,
                               std::size_t k, bool before) {
  if (before ? k == 0 : k + 1 >= line.size()) return {};
  const RegionId region = line[before ? k - 1 : k + 1].region;
  return region < kFirstRegion ? std::string_view()
                               : std::string_view(joint.tissue_of(region).name);
}

}  // namespace

std::string clinical_name(Language language, const std::string& name) {
  if (language == Language::french) {
    for (const Name& known : kFrench) {
      if (known.name == name) return known.french;
    }
  }
  if (name == "outside") return "outside the body";
  if (name == "beyond") return "beyond the model";
  if (name == "injected") return "injected liquid";
  std::string plain = name;
  std::replace(plain.begin(), plain.end(), '_', ' ');
  return plain;
}

std::string layer_name(Language language, const CompiledJoint& joint,
                       std::span<const TissueInterval> line, std::size_t k) {
  const RegionId region = line[k].region;
  if (!is_filling(joint, region)) return clinical_name(language, joint.regions[region].name);
  const bool french = language == Language::french;
  const std::string_view before = tissue_beside(joint, line, k, true);
  const std::string_view after = tissue_beside(joint, line, k, false);
  if (before == "bursa" || after == "bursa")
    return french ? "graisse autour de la bourse" : "fat around the bursa";
  if (before == "skin" || after == "skin" || before.empty())  // on the way in or out
    return french ? "graisse sous la peau" : "fat under the skin";
  return french ? "graisse entre les muscles" : "fat between the muscles";
}

}  // namespace artus
