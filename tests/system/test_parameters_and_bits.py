"""The groups of parameters and flags."""

import pytest

from openacr.map import flags, parameters


@pytest.mark.req("ACR-PAR-15")
def test_every_group_of_parameters_and_flags_is_there() -> None:
    objects = {row.object for row in parameters().values()}
    assert {"MASTER", "AXIS", "ENC", "DAC", "ADC", "PROG"} <= objects
    assert {"MASTER", "AXIS", "PROG"} <= {row.object for row in flags().values()}
