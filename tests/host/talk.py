"""A session and a fake device in one thread, on a clock that the test moves."""

from __future__ import annotations

from dataclasses import dataclass, field

from edgeline.session import Event, Frame, Session
from fake_device import FakeDevice


@dataclass
class Talk:
    device: FakeDevice = field(default_factory=FakeDevice)
    session: Session = field(default_factory=Session)
    now: float = 100.0
    events: list[Event] = field(default_factory=list)

    def step(self, seconds: float = 0.02) -> list[Event]:
        """One exchange in both directions, then `seconds` pass."""
        self.now += seconds
        events = self.session.tick(self.now)
        self.device.receive(self.session.bytes_to_send(), self.now)
        events += self.session.receive(self.device.run(self.now), self.now)
        self.device.receive(self.session.bytes_to_send(), self.now)
        self.events += events
        return events

    def run(self, steps: int) -> list[Event]:
        return [event for _ in range(steps) for event in self.step()]

    @property
    def frames(self) -> list[Frame]:
        return [event for event in self.events if isinstance(event, Frame)]
