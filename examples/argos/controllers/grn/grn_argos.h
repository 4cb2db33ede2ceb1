// A robot of grn in ARGoS: an e-puck2 with positioning, proximity, and range and bearing.
#pragma once

#include <grn.h>

#include <argos3/core/control_interface/ci_controller.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/plugins/robots/e-puck2/control_interface/ci_epuck2_proximity_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_differential_steering_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_positioning_sensor.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_actuator.h>
#include <argos3/plugins/robots/generic/control_interface/ci_range_and_bearing_sensor.h>

#include <cstdint>
#include <vector>

// Parameters of <params>: `blob` (the file that `grn evolve` wrote), `robot` (its number, unique in the swarm), `tick` (seconds
// between two control steps), `packet` (bytes of the range-and-bearing board's packets, at least 3), `touching` (what a proximity
// sensor reads at the body's edge, 4095 if it is not given).
class CGrnController : public argos::CCI_Controller {
public:
    void Init(argos::TConfigurationNode& node) override;
    void ControlStep() override;
    void Reset() override;

    // What a mother robot sees until the next step: loop functions call this, for they know the arena. Metres in the world. More than
    // four targets or eight points are left out.
    void SeeTarget(std::uint8_t target, const argos::CVector2& place);
    void SeeObstacle(const argos::CVector2& point);

private:
    void Load();
    void Sense();
    void Hear();
    void Say(const GrnMessage& message);
    void SendNext();

    argos::CCI_DifferentialSteeringActuator* m_wheels = nullptr;
    argos::CCI_EPuck2ProximitySensor* m_proximity = nullptr;
    argos::CCI_PositioningSensor* m_positioning = nullptr;
    argos::CCI_RangeAndBearingActuator* m_sender = nullptr;
    argos::CCI_RangeAndBearingSensor* m_receiver = nullptr;

    std::vector<std::uint8_t> m_blob;
    std::uint32_t m_robot = 0;
    std::uint32_t m_packet = 40;
    argos::Real m_tick = 1.0 / GRN_TICKS_PER_SECOND;
    argos::Real m_touching = 4095.0;

    GrnController m_controller = {};
    GrnAssembler m_assembler = {};
    GrnPercept m_percept = GRN_PERCEPT_NOTHING;
    // What is still to be sent: a packet holds one fragment, with its length before it.
    std::vector<std::vector<std::uint8_t>> m_waiting;
    std::uint8_t m_message = 0;
    std::uint32_t m_time = 0;
};
