"""A session and a fake device in one thread, on a clock that the test moves."""

from __future__ import annotations

from dataclasses import dataclass, field

from edgeline.session import Event, Frame, Session, SetRate
from fake_device import FakeDevice
from faults import garbled


@dataclass
class Talk:
    device: FakeDevice = field(default_factory=FakeDevice)
    session: Session = field(default_factory=Session)
    now: float = 100.0
    events: list[Event] = field(default_factory=list)
    rate: int = 0
    """of the host's port; 0: the device's, whatever it is"""

    def step(self, seconds: float = 0.02) -> list[Event]:
        """One exchange in both directions, then `seconds` pass."""
        self.now += seconds
        events = self._carry_out(self.session.tick(self.now))
        for rate, data in self.device.run_at_rates(self.now):
            heard = garbled(data, rate, self.rate or rate)
            events += self._carry_out(self.session.receive(heard, self.now))
        self.events += events
        return events

    def _carry_out(self, events: list[Event]) -> list[Event]:
        """What a Link does with a session's events and bytes."""
        for event in events:
            if isinstance(event, SetRate):
                self.rate = event.rate
        self.device.receive(self.session.bytes_to_send(), self.now, self.rate or None)
        return events

    def run(self, steps: int) -> list[Event]:
        return [event for _ in range(steps) for event in self.step()]

    @property
    def frames(self) -> list[Frame]:
        return [event for event in self.events if isinstance(event, Frame)]
