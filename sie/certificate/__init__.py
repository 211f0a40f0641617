"""The certificate: measures of the accuracy of every answer."""
